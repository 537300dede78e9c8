#include "pack_tool/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <bit>
#include <charconv>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "galactic/error.h"
#include "pack_tool/diff/report_diff.h"
#include "pack_tool/option_values.h"
#include "pack_tool/pictures/figure_picture.h"
#include "pack_tool/verbs/verbs.h"
#include "support/text/help_lines.h"
#include "support/text/nearest_name.h"
#include "support/text/number_text.h"

namespace galactic::pack_tool {

namespace {

/// More than any length in a pack.
constexpr double kMostMeters = 1000;
/// A million times as much.
constexpr double kMostShare = 1e6;

void checkSwitches(CLI::App& app) {
  for (CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    for (CLI::Option* option : verb->get_options()) {
      if (option->get_expected_max() == 0) option->check(switchCheck());
    }
  }
}

void addJson(CLI::App& verb, OutputForm& form) {
  verb.add_flag_callback(
      "--json", [&form] { form = OutputForm::kJson; }, "Print JSON instead of text");
}

void addTrusted(CLI::App& verb, Trust& trust) {
  verb.add_flag_callback(
      "--trusted", [&trust] { trust = Trust::kTrusted; },
      "Skip verification: use it only for packs verified before");
}

void addRadius(CLI::App& verb, std::optional<float>& radius) {
  verb.add_option("--radius", radius, "Scenes: only the grid of this sphere radius")
      ->check(numberCheck(0, kMostMeters))
      ->type_name("METERS");
}

/// Which packs a verb takes.
struct PackOption {
  std::string name;
  std::string meaning;
};

void addPack(CLI::App& verb, const PackOption& option, std::filesystem::path& pack) {
  verb.add_option(option.name, pack, option.meaning)->required()->type_name("");
}

void addOutput(CLI::App& verb, std::filesystem::path& output) {
  verb.add_option("-o,--out", output, "The file to write; replaced if it exists")
      ->required()
      ->type_name("FILE");
}

void addPacks(CLI::App& verb, std::vector<std::filesystem::path>& packs) {
  verb.add_option("PACK", packs, "Packs of any kind")->required()->type_name("");
}

/// Adds the verbs to a parser, and has `chosen` run the one that is typed.
class Verbs {
 public:
  Verbs(CLI::App& app, ChosenVerb& chosen) : app_(app), chosen_(chosen) {}

  /// `check` throws a CLI::ParseError where options do not fit together.
  template <class Options>
  void add(const char* name, const char* meaning, void (*add_options)(CLI::App&, Options&),
           int (*run)(const Options&, const Console&),
           void (*check)(const CLI::App&, const Options&) = nullptr) {
    CLI::App* verb = app_.add_subcommand(name, meaning)->group("Verbs");
    const auto options = std::make_shared<Options>();
    add_options(*verb, *options);
    verb->final_callback([&chosen = chosen_, verb, options, run, check] {
      if (check != nullptr) check(*verb, *options);
      chosen = [options, run](const Console& console) { return run(*options, console); };
    });
  }

 private:
  CLI::App& app_;
  ChosenVerb& chosen_;
};

void addInfoOptions(CLI::App& verb, InfoOptions& options) {
  addPacks(verb, options.packs);
  addJson(verb, options.form);
  addTrusted(verb, options.trust);
}

void addCheckOptions(CLI::App& verb, CheckOptions& options) {
  verb.add_option("PACK", options.packs, "Packs of any kind, and folders with packs in them")
      ->required()
      ->type_name("");
  addJson(verb, options.form);
  verb.add_option("--junit", options.junit,
                  "Also write a JUnit report, for CI; replaced if it exists")
      ->type_name("FILE");
  verb.add_option("-j,--threads", options.threads,
                  "Threads; what is printed does not depend on it; 0: one per processor")
      ->check(wholeCheck(0, 4096))
      ->option_text(fmt::format("N [{}]", options.threads));
  verb.add_flag_callback(
      "-q,--quiet", [&options] { options.is_quiet = true; }, "Only errors");
}

void addColumnOptions(CLI::App& verb, ColumnOptions& options) {
  addPack(verb, {"PACK", "A scene pack"}, options.pack);
  verb.add_option_function<std::string>(
          "--at",
          [&options](const std::string& text) {
            const auto [x, z] = parseNumbers<2>("--at", text);
            options.at = {x, z};
          },
          "The point, meters")
      ->required()
      ->type_name("X,Z");
  addRadius(verb, options.radius);
  addJson(verb, options.form);
  addTrusted(verb, options.trust);
}

/// Packs and reports have options of their own.
void checkDiff(const CLI::App& verb, const DiffOptions& options) {
  const bool are_reports = isReport(options.a);
  if (are_reports != isReport(options.b)) {
    throw CLI::ValidationError(
        "diff", fmt::format("found the report {} and the pack {}; give two packs or two reports",
                            (are_reports ? options.a : options.b).string(),
                            (are_reports ? options.b : options.a).string()));
  }
  const std::vector<const char*> misplaced =
      are_reports ? std::vector<const char*>{"--tolerance", "--content-only", "--trusted"}
                  : std::vector<const char*>{"--share"};
  for (const char* option : misplaced) {
    if (verb.count(option) == 0) continue;
    throw CLI::ValidationError(
        option, fmt::format("is about {}, found two {}; leave it out",
                            are_reports ? "packs" : "reports", are_reports ? "reports" : "packs"));
  }
}

void addDiffOptions(CLI::App& verb, DiffOptions& options) {
  addPack(verb, {"A", "A pack of any kind, or the golden report: a .json file"}, options.a);
  addPack(verb, {"B", "Another pack of the same kind, or the report to compare"}, options.b);
  verb.add_option("--tolerance", options.tolerance, "Lengths that differ by no more are equal")
      ->check(numberCheck(0, kMostMeters))
      ->option_text(fmt::format("METERS [{}]", options.tolerance));
  verb.add_option(
          "--share", options.share,
          "Numbers of reports that differ by no more than this share are equal; 0.01 is 1 %")
      ->check(numberCheck(0, kMostShare))
      ->type_name("SHARE");
  verb.add_flag_callback(
      "--content-only", [&options] { options.scope = DiffScope::kContent; },
      "Ignore provenance, options and statistics: compare what is simulated");
  addJson(verb, options.form);
  addTrusted(verb, options.trust);
}

/// What only objects and robots have: `figures` is filled when one of them is given.
void addFigureOptions(CLI::App& verb, std::optional<FigureOptions>& figures) {
  const auto given = [&figures]() -> FigureOptions& {
    return figures ? *figures : figures.emplace();
  };
  verb.add_option_function<std::string>(
          "--object", [given](const std::string& name) { given().object = name; },
          "Objects: only the object of this name")
      ->type_name("NAME");
  verb.add_option_function<std::string>(
          "--joints",
          [given](const std::string& text) { given().joints.values = parseJoints(text); },
          "Robots: joint values, radians or meters; the other joints are in the start pose")
      ->type_name("NAME=VALUE,...");
  verb.add_flag_callback(
      "--all-zero", [given] { given().joints.others = OtherJoints::kZero; },
      "Robots: put joints that --joints does not name at 0");
  verb.add_option_function<std::string>(
          "--what", [given](const std::string& text) { given().layers = parseLayers(text); },
          "What to show (objects and robots: by default all of mesh,spheres,boxes; picture of a "
          "scene: mesh, instead of its grids)")
      ->type_name("LAYER,...");
}

void addGridPictureOptions(CLI::App& verb, GridPictureOptions& options) {
  using pictures::PlanValue;
  addRadius(verb, options.radius);
  verb.add_option_function<std::string>(
          "--slice",
          [&options](const std::string& text) {
            const auto [x0, z0, x1, z1] = parseNumbers<4>("--slice", text);
            options.slice = SliceLine{{x0, z0}, {x1, z1}};
          },
          "Scenes: a vertical slice along this line instead of a plan, meters")
      ->type_name("X0,Z0,X1,Z1");
  verb.add_option("--value", options.value,
                  "Scenes: color a plan by total free height, by the height of the lowest span, "
                  "or by the number of spans (default total)")
      ->transform(choice(std::map<std::string, PlanValue>{{"total", PlanValue::kTotalHeight},
                                                          {"lowest", PlanValue::kLowestHeight},
                                                          {"spans", PlanValue::kSpanCount}}))
      ->type_name("total|lowest|spans");
}

void addEpisodePictureOptions(CLI::App& verb, EpisodePictureOptions& options) {
  verb.add_option("--scene", options.scene, "Worlds and episodes: only the scene of this name")
      ->type_name("NAME");
  verb.add_option("--episode", options.episode,
                  "Worlds and episodes: only the episode of this number, from 0 on, in its scene")
      ->check(wholeCheck(0, std::numeric_limits<std::int32_t>::max()))
      ->type_name("N");
}

void addPictureOptions(CLI::App& verb, PictureOptions& options) {
  addPack(verb, {"PACK", "A pack of any kind but policies and textures"}, options.pack);
  addOutput(verb, options.output);
  addGridPictureOptions(verb, options.grids);
  addFigureOptions(verb, options.figures);
  addEpisodePictureOptions(verb, options.episodes);
  verb.add_option(
          "--size", options.size,
          fmt::format("Meshes, objects and robots: edge of a view (default {}, on a contact sheet "
                      "{}), at most {}; plans and slices: about their width",
                      pictures::kDefaultViewSize, pictures::kDefaultTileSize,
                      pictures::kLargestView))
      ->check(wholeCheck(pictures::kSmallestView, pictures::kLargestPlot))
      ->type_name("PIXELS");
  addTrusted(verb, options.trust);
}

void addReportOptions(CLI::App& verb, ReportOptions& options) {
  addPacks(verb, options.packs);
  addOutput(verb, options.output);
  addTrusted(verb, options.trust);
}

void addViewOptions(CLI::App& verb, ViewOptions& options) {
  addPack(verb, {"PACK", "A pack of any kind"}, options.pack);
  addOutput(verb, options.output);
  const CLI::Validator is_power_of_two(
      [](const std::string& text) {
        std::uint32_t edge = 0;
        std::from_chars(text.data(), text.data() + text.size(), edge);
        return std::has_single_bit(edge) ? std::string()
                                         : fmt::format("found {}, expected a power of two", text);
      },
      "", "texture_size");
  verb.add_option("--texture-size", options.texture_size,
                  "Longest edge of a texture, texels: a power of two")
      ->check(wholeCheck(1, 4096))
      ->check(is_power_of_two)
      ->option_text(fmt::format("N [{}]", options.texture_size));
  addTrusted(verb, options.trust);
}

void addEpisodeSetOptions(CLI::App& verb, ExportOptions& options) {
  verb.add_option("--object-up", options.object_up,
                  "Episode sets: up axis of the objects' mesh files (default z)")
      ->transform(choice(std::map<std::string, FileUp>{{"x", FileUp::kX},
                                                       {"y", FileUp::kY},
                                                       {"z", FileUp::kZ},
                                                       {"-x", FileUp::kMinusX},
                                                       {"-y", FileUp::kMinusY},
                                                       {"-z", FileUp::kMinusZ}}))
      ->type_name("AXIS");
}

void checkExport(const CLI::App& /*verb*/, const ExportOptions& options) {
  if (options.output.empty() && options.format != ExportFormat::kEpisodeSet) {
    throw CLI::RequiredError("--out");
  }
  const std::string fault = exportFault(options);
  if (!fault.empty()) throw CLI::ParseError(fault, CLI::ExitCodes::ValidationError);
}

void addExportOptions(CLI::App& verb, ExportOptions& options) {
  addPack(verb, {"PACK", "A pack of a scene, of objects, of a robot or of episodes, or a world"},
          options.pack);
  verb.add_option("-o,--out", options.output,
                  "The file to write; replaced if it exists (default for episode_set: "
                  "NAME.episode_set.json)")
      ->type_name("FILE");
  addEpisodeSetOptions(verb, options);
  verb.add_option("--to", options.format, "Format (default: that of the extension of FILE)")
      ->transform(
          choice(std::map<std::string, ExportFormat>{{"obj", ExportFormat::kObj},
                                                     {"ply", ExportFormat::kPly},
                                                     {"glb", ExportFormat::kGlb},
                                                     {"srdf", ExportFormat::kSrdf},
                                                     {"urdf", ExportFormat::kUrdf},
                                                     {"episode_set", ExportFormat::kEpisodeSet}}))
      ->type_name("glb|srdf|urdf|obj|ply|episode_set");
  addFigureOptions(verb, options.figures);
  addRadius(verb, options.radius);
  verb.add_flag_callback(
      "--surface", [&options] { options.patch_height = PatchHeight::kSurface; },
      "OBJ, PLY: patches one radius beyond the free spans, where level surfaces are");
  verb.add_flag_callback(
      "--floors-only", [&options] { options.parts = MeshParts::kFloors; }, "OBJ, PLY: no ceilings");
  addTrusted(verb, options.trust);
}

std::vector<std::string> namesOfVerbs(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(verb->get_name());
  }
  return names;
}

/// Of the program and of the verb that was typed.
std::vector<std::string> longNamesOf(const CLI::App& app) {
  std::vector<std::string> names;
  const auto add = [&names](const CLI::App& one) {
    for (const CLI::Option* option : one.get_options()) names.push_back(option->get_name());
  };
  add(app);
  for (const CLI::App* verb : app.get_subcommands()) add(*verb);
  return names;
}

int usageError(const Console& console, std::string_view message) {
  console.err << fmt::format("galactic-pack: command line: {}; see galactic-pack --help\n",
                             printable(message));
  return kExitUsage;
}

/// The parser misses an option before it minds one that it does not know: most likely that is the
/// same one, misspelt.
std::string complaintOf(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_name() == "RequiredError") {
    for (const std::string& unknown : app.remaining(true)) {
      if (unknown.starts_with("--")) return "The following argument was not expected: " + unknown;
    }
  }
  return error.what();
}

}  // namespace

tl::expected<ChosenVerb, int> parseCommandLine(int argc, const char* const* argv,
                                               const Console& console) {
  CLI::App app("Inspects, checks, compares, exports, draws and shows packs.", "galactic-pack");
  // Verbs inherit the footer that is set before them.
  app.footer(kExitCodesHelp);
  app.set_version_flag("--version", "galactic-pack " GALACTIC_VERSION);
  app.formatter(std::make_shared<HelpLines<CLI::Formatter, CLI::Option>>());
  app.get_formatter()->label("SUBCOMMAND", "VERB");
  app.require_subcommand(1);
  ChosenVerb chosen;
  Verbs verbs(app, chosen);
  verbs.add("info", "Tell what is in packs", addInfoOptions, runInfo);
  verbs.add("check", "Verify packs completely; the exit code is that of the worst one",
            addCheckOptions, runCheck);
  verbs.add("column", "Print the free spans of the column nearest to a point", addColumnOptions,
            runColumn);
  verbs.add(
      "diff",
      "Compare two packs of one kind by their meaning, or two reports of galactic-bake; exit code "
      "7 if they differ",
      addDiffOptions, runDiff, checkDiff);
  verbs.add("export", "Write a scene's grid, objects, a robot or episodes for other programs",
            addExportOptions, runExport, checkExport);
  verbs.add("picture", "Draw a scene, objects, a robot or the episodes of a world into a PNG file",
            addPictureOptions, runPicture);
  verbs.add("report", "Write an HTML page with a picture of everything in packs or a world",
            addReportOptions, runReport);
  verbs.add("view", "Write an HTML page that shows a pack or a world in three dimensions",
            addViewOptions, runView);
  checkSwitches(app);

  const std::vector<std::string> names = namesOfVerbs(app);
  const std::string any_verb = fmt::format(
      "{} or {}", fmt::join(std::span(names).first(names.size() - 1), ", "), names.back());
  if (argc < 2) {
    return tl::unexpected(usageError(console, fmt::format("no verb; give {}", any_verb)));
  }
  const std::string first = argv[1];
  const auto named = [&first](const CLI::App* verb) { return verb->get_name() == first; };
  if (!first.starts_with('-') && app.get_subcommands(named).empty()) {
    const std::string nearest = suggestNames(first, names);
    const std::string advice = nearest.starts_with("did you") ? nearest : "give " + any_verb;
    return tl::unexpected(
        usageError(console, fmt::format("\"{}\" is not a verb; {}", first, advice)));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return tl::unexpected(app.exit(help, console.out, console.err));
  } catch (const CLI::ParseError& error) {
    return tl::unexpected(
        usageError(console, withSuggestions(complaintOf(app, error), longNamesOf(app))));
  }
  return chosen;
}

}  // namespace galactic::pack_tool
