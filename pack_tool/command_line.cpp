#include "pack_tool/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

namespace galactic::pack_tool {

namespace {

constexpr const char* kFooter =
    "Exit codes:\n"
    "  0 ok  1 command line  2 input or output  3 invalid input  4 internal\n"
    "  5 unsupported  7 the packs differ";

/// Exactly `Count` finite numbers separated by commas.
template <std::size_t Count>
std::array<double, Count> parseNumbers(const std::string& option, const std::string& text) {
  std::array<double, Count> numbers{};
  const char* from = text.data();
  const char* const end = from + text.size();
  bool good = true;
  for (std::size_t n = 0; n < Count && good; ++n) {
    if (n > 0) good = from != end && *from++ == ',';
    const auto parsed = std::from_chars(from, end, numbers[n]);
    good = good && parsed.ec == std::errc() && std::isfinite(numbers[n]);
    from = parsed.ptr;
  }
  if (!good || from != end) {
    throw CLI::ValidationError(
        option, fmt::format("\"{}\" is not {} numbers separated by commas", text, Count));
  }
  return numbers;
}

void addJson(CLI::App& verb, OutputForm& form) {
  verb.add_flag_callback(
      "--json", [&form] { form = OutputForm::kJson; }, "print JSON instead of text");
}

void addTrusted(CLI::App& verb, Trust& trust) {
  verb.add_flag_callback(
      "--trusted", [&trust] { trust = Trust::kTrusted; },
      "skip the verification: only for packs verified before");
}

void addRadius(CLI::App& verb, std::optional<float>& radius) {
  verb.add_option("--radius", radius, "only the grid of this sphere radius")->type_name("METRES");
}

void addPack(CLI::App& verb, const std::string& name, std::filesystem::path& pack) {
  verb.add_option(name, pack, "a scene pack")->required()->type_name("PACK");
}

void addPacks(CLI::App& verb, std::vector<std::filesystem::path>& packs) {
  verb.add_option("packs", packs, "packs of any kind")->required()->type_name("PACK");
}

/// The options of all verbs, filled while parsing.
struct AllOptions {
  InfoOptions info;
  CheckOptions check;
  ColumnOptions column;
  DiffOptions diff;
  ExportOptions export_;
};

void addInfo(CLI::App& app, InfoOptions& options) {
  CLI::App& verb = *app.add_subcommand("info", "Tell what is in packs");
  addPacks(verb, options.packs);
  addJson(verb, options.form);
  addTrusted(verb, options.trust);
}

void addCheck(CLI::App& app, CheckOptions& options) {
  CLI::App& verb = *app.add_subcommand(
      "check", "Verify packs completely; the exit code is that of the worst one");
  addPacks(verb, options.packs);
  addJson(verb, options.form);
}

void addColumn(CLI::App& app, ColumnOptions& options) {
  CLI::App& verb =
      *app.add_subcommand("column", "Print the free spans of the column nearest to a point");
  addPack(verb, "pack", options.pack);
  verb.add_option_function<std::string>(
          "--at",
          [&options](const std::string& text) {
            const auto [x, z] = parseNumbers<2>("--at", text);
            options.at = {x, z};
          },
          "the point, metres")
      ->required()
      ->type_name("X,Z");
  addRadius(verb, options.radius);
  addJson(verb, options.form);
  addTrusted(verb, options.trust);
}

void addDiff(CLI::App& app, DiffOptions& options) {
  CLI::App& verb = *app.add_subcommand(
      "diff", "Compare two scene packs by their meaning; exit code 7 when they differ");
  addPack(verb, "a", options.a);
  addPack(verb, "b", options.b);
  verb.add_option("--tolerance", options.tolerance,
                  "lengths that differ by no more are equal (default 0)")
      ->check(CLI::NonNegativeNumber)
      ->type_name("METRES");
  verb.add_flag_callback(
      "--content-only", [&options] { options.scope = DiffScope::kContent; },
      "ignore provenance, options and statistics: compare what is simulated");
  addJson(verb, options.form);
  addTrusted(verb, options.trust);
}

void addPictureOptions(CLI::App& verb, ExportOptions& options) {
  using pictures::PlanValue;
  verb.add_option_function<std::string>(
          "--slice",
          [&options](const std::string& text) {
            const auto [x0, z0, x1, z1] = parseNumbers<4>("--slice", text);
            options.slice = SliceLine{{x0, z0}, {x1, z1}};
          },
          "PNG: a vertical slice along this line instead of a plan, metres")
      ->type_name("X0,Z0,X1,Z1");
  verb.add_option("--value", options.value,
                  "PNG plan: colour by total free height, by the height of the lowest span, or by "
                  "the number of spans (default total)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, PlanValue>{{"total", PlanValue::kTotalHeight},
                                           {"lowest", PlanValue::kLowestHeight},
                                           {"spans", PlanValue::kSpanCount}}))
      ->type_name("total|lowest|spans");
}

void addExport(CLI::App& app, ExportOptions& options) {
  CLI::App& verb = *app.add_subcommand("export", "Write a picture or a mesh of a scene's grids");
  addPack(verb, "pack", options.pack);
  verb.add_option("-o,--output", options.output, "the file to write; replaced if it is there")
      ->required()
      ->type_name("FILE");
  verb.add_option("--to", options.format, "format (default: by the extension of FILE)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, ExportFormat>{
          {"png", ExportFormat::kPng}, {"obj", ExportFormat::kObj}, {"ply", ExportFormat::kPly}}))
      ->type_name("png|obj|ply");
  addRadius(verb, options.radius);
  addPictureOptions(verb, options);
  verb.add_flag_callback(
      "--surface", [&options] { options.patch_height = PatchHeight::kSurface; },
      "OBJ, PLY: patches a radius beyond the free spans, where level surfaces are");
  verb.add_flag_callback(
      "--floors-only", [&options] { options.parts = MeshParts::kFloors; }, "OBJ, PLY: no ceilings");
  addTrusted(verb, options.trust);
}

Request chosenRequest(const CLI::App& app, AllOptions& options) {
  if (app.got_subcommand("info")) return std::move(options.info);
  if (app.got_subcommand("check")) return std::move(options.check);
  if (app.got_subcommand("column")) return std::move(options.column);
  if (app.got_subcommand("diff")) return std::move(options.diff);
  return std::move(options.export_);
}

int usageError(const Console& console, std::string_view message) {
  console.err << fmt::format("galactic-pack: command line: {}; see galactic-pack --help\n",
                             printable(message));
  return kExitUsage;
}

}  // namespace

tl::expected<Request, int> parseCommandLine(int argc, const char* const* argv,
                                            const Console& console) {
  CLI::App app("galactic-pack looks into packs, checks, compares and exports them.",
               "galactic-pack");
  AllOptions options;
  // Verbs inherit the footer that is set before them.
  app.footer(kFooter);
  app.set_version_flag("--version", "galactic-pack " GALACTIC_VERSION);
  app.require_subcommand(1);
  addInfo(app, options.info);
  addCheck(app, options.check);
  addColumn(app, options.column);
  addDiff(app, options.diff);
  addExport(app, options.export_);

  constexpr std::string_view kVerbs = "info, check, column, diff or export";
  if (argc < 2) return tl::unexpected(usageError(console, fmt::format("no verb; give {}", kVerbs)));
  const std::string first = argv[1];
  const auto named = [&first](const CLI::App* verb) { return verb->get_name() == first; };
  if (!first.starts_with('-') && app.get_subcommands(named).empty()) {
    return tl::unexpected(
        usageError(console, fmt::format("\"{}\" is no verb; give {}", first, kVerbs)));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return tl::unexpected(app.exit(help, console.out, console.err));
  } catch (const CLI::ParseError& error) {
    return tl::unexpected(usageError(console, error.what()));
  }
  return chosenRequest(app, options);
}

}  // namespace galactic::pack_tool
