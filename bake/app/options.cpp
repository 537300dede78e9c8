#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <string_view>
#include <thread>

namespace galactic::bake {
namespace {

constexpr const char* kFooter =
    "Exit codes: 0 ok, 1 command line, 2 I/O, 3 invalid input, 4 internal, 5 unsupported, 7 "
    "differs.\n"
    "Example: galactic-bake scene.glb --radii 0.015,0.05,0.12";

/// The texts that need more than CLI11's own conversions.
struct RawOptions {
  std::vector<std::string> radii{"0.015", "0.05", "0.12"};
  std::string spacing = "0.03";
  std::string up;
  std::string scale;
  std::string transform;
  std::vector<std::string> seeds;
};

Result<std::vector<double>> parseNumbers(const std::string& text, const char* option) {
  std::vector<double> numbers;
  std::string_view rest = text;
  while (true) {
    const std::size_t comma = rest.find(',');
    const std::string_view part = rest.substr(0, comma);
    double number = 0;
    const auto [end, problem] = std::from_chars(part.data(), part.data() + part.size(), number);
    if (problem != std::errc() || end != part.data() + part.size() || !std::isfinite(number)) {
      return fail(
          ErrorCode::kInvalidInput, option,
          fmt::format("has \"{}\" in \"{}\", numbers separated by commas are wanted", part, text));
    }
    numbers.push_back(number);
    if (comma == std::string_view::npos) return numbers;
    rest.remove_prefix(comma + 1);
  }
}

Result<std::vector<double>> parseExactly(const std::string& text, const char* option,
                                         std::size_t count) {
  auto numbers = parseNumbers(text, option);
  if (numbers && numbers->size() != count) {
    return fail(
        ErrorCode::kInvalidInput, option,
        fmt::format("has {} numbers in \"{}\", {} are wanted", numbers->size(), text, count));
  }
  return numbers;
}

/// 12 numbers (three rows) or 16 (four rows, the last one 0,0,0,1).
Result<Affine> parseTransform(const std::string& text) {
  auto numbers = parseNumbers(text, "--transform");
  if (!numbers) return tl::unexpected(numbers.error());
  const bool has_last_row = numbers->size() == 16 && (*numbers)[12] == 0 && (*numbers)[13] == 0 &&
                            (*numbers)[14] == 0 && (*numbers)[15] == 1;
  if (numbers->size() != 12 && !has_last_row) {
    return fail(ErrorCode::kInvalidInput, "--transform",
                fmt::format("has {} numbers, 12 (three rows of four) are wanted, or 16 whose last "
                            "row is 0,0,0,1",
                            numbers->size()));
  }
  Affine transform{};
  std::copy_n(numbers->begin(), transform.size(), transform.begin());
  return transform;
}

Result<UpAxis> parseUp(const std::string& text) {
  const std::map<std::string, UpAxis> axes{{"x", UpAxis::kX},       {"y", UpAxis::kY},
                                           {"z", UpAxis::kZ},       {"-x", UpAxis::kMinusX},
                                           {"-y", UpAxis::kMinusY}, {"-z", UpAxis::kMinusZ}};
  const auto axis = axes.find(text);
  if (axis != axes.end()) return axis->second;
  return fail(ErrorCode::kInvalidInput, "--up",
              fmt::format("is \"{}\", one of x, y, z, -x, -y, -z is wanted", text));
}

Result<void> understandImport(const RawOptions& raw, BakeCommand& command) {
  if (!raw.up.empty()) {
    const auto up = parseUp(raw.up);
    if (!up) return tl::unexpected(up.error());
    command.import.up = *up;
  }
  if (!raw.scale.empty()) {
    const auto scale = parseExactly(raw.scale, "--scale", 1);
    if (!scale) return tl::unexpected(scale.error());
    if (!((*scale)[0] > 0)) {
      return fail(ErrorCode::kInvalidInput, "--scale",
                  fmt::format("is {}, metres per unit have to be positive", raw.scale));
    }
    command.import.scale = (*scale)[0];
  }
  if (!raw.transform.empty()) {
    const auto transform = parseTransform(raw.transform);
    if (!transform) return tl::unexpected(transform.error());
    command.import.transform = *transform;
  }
  return {};
}

std::string joined(const std::vector<std::string>& parts) {
  return fmt::format("{}", fmt::join(parts, ","));
}

Result<void> understandScene(const RawOptions& raw, BakeCommand& command) {
  const auto radii = parseNumbers(joined(raw.radii), "--radii");
  if (!radii) return tl::unexpected(radii.error());
  command.scene.radii.clear();
  for (const double radius : *radii) command.scene.radii.push_back(static_cast<float>(radius));
  const auto spacing = parseExactly(raw.spacing, "--spacing", 1);
  if (!spacing) return tl::unexpected(spacing.error());
  command.scene.spacing = static_cast<float>((*spacing)[0]);
  for (const std::string& seed : raw.seeds) {
    const auto point = parseExactly(seed, "--seed", 3);
    if (!point) return tl::unexpected(point.error());
    command.scene.free_space.seeds.push_back({static_cast<float>((*point)[0]),
                                              static_cast<float>((*point)[1]),
                                              static_cast<float>((*point)[2])});
  }
  return {};
}

template <class T>
std::string nameOf(const std::map<std::string, T>& names, T value) {
  for (const auto& [name, candidate] : names) {
    if (candidate == value) return name;
  }
  return {};
}

const std::map<std::string, Engine>& engineNames() {
  static const std::map<std::string, Engine> names{
      {"exact", Engine::kExact}, {"bullet", Engine::kBullet}, {"embree", Engine::kEmbree}};
  return names;
}

const std::map<std::string, Coverage>& coverageNames() {
  static const std::map<std::string, Coverage> names{{"column", Coverage::kColumn},
                                                     {"cell", Coverage::kCell}};
  return names;
}

const std::map<std::string, Keep>& keepNames() {
  static const std::map<std::string, Keep> names{{"room", Keep::kRoom}, {"all", Keep::kAll}};
  return names;
}

/// In this order in every pack; only what decides the content.
void rememberContentOptions(const RawOptions& raw, BakeCommand& command) {
  auto& options = command.content_options;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) options.emplace_back(name, value);
  };
  add("radii", joined(raw.radii));
  add("spacing", raw.spacing);
  add("engine", nameOf(engineNames(), command.scene.engine));
  add("coverage", nameOf(coverageNames(), command.scene.coverage));
  add("keep", nameOf(keepNames(), command.scene.free_space.keep));
  if (raw.seeds.empty()) {
    add("keep-components", std::to_string(command.scene.free_space.components));
  }
  for (const std::string& seed : raw.seeds) add("seed", seed);
  add("check-columns", std::to_string(command.scene.check_columns));
  add("up", raw.up);
  add("scale", raw.scale);
  add("transform", raw.transform);
}

void addImportOptions(CLI::App& app, RawOptions& raw) {
  app.add_option("--up", raw.up, "Up axis of the input: x, y, z, -x, -y, -z (default: the file's)")
      ->type_name("AXIS");
  app.add_option("--scale", raw.scale, "Metres per unit of the input (default: the file's)")
      ->type_name("METRES");
  app.add_option("--transform", raw.transform,
                 "Applied last, Y up and metres: 12 or 16 numbers, row by row")
      ->type_name("N,N,...");
}

void addGridOptions(CLI::App& app, RawOptions& raw, BakeCommand& command) {
  SceneBakeOptions& scene = command.scene;
  app.add_option("--radii", raw.radii, "Sphere radii, metres, ascending")
      ->type_name("R,R,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->default_str("0.015,0.05,0.12");
  app.add_option("--spacing", raw.spacing, "Edge of a cell, metres; at most twice the least radius")
      ->type_name("METRES")
      ->capture_default_str();
  app.add_option("--coverage", scene.coverage,
                 "column: free on the cell's centre line; cell: free over the whole cell")
      ->transform(CLI::CheckedTransformer(coverageNames()))
      ->option_text("column|cell");
  app.add_option("--engine", scene.engine,
                 "exact: closed form; bullet: the published sphere casts; embree: rays")
      ->transform(CLI::CheckedTransformer(engineNames()))
      ->option_text("exact|bullet|embree");
  app.add_option("--seed", raw.seeds,
                 "A point of the room (may be repeated): x,y,z in metres, y up")
      ->type_name("X,Y,Z")
      ->allow_extra_args(false);
  app.add_option("--keep", scene.free_space.keep, "What to store: the room, or all free spans")
      ->transform(CLI::CheckedTransformer(keepNames()))
      ->option_text("room|all");
  app.add_option("--keep-components", scene.free_space.components,
                 "Without seeds: how many of the largest free parts are the room")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_option("--check-columns", scene.check_columns,
                 "Columns per grid to replay with sphere casts; 0: none")
      ->capture_default_str();
}

void addRunOptions(CLI::App& app, BakeCommand& command) {
  app.add_option("input", command.inputs, "Scene meshes: GLB, glTF, OBJ, PLY, STL, DAE, ...")
      ->required()
      ->option_text("INPUT...");
  app.add_option("-o,--out", command.output,
                 "Pack to write, or a folder for several inputs (default: NAME.pack)")
      ->type_name("OUT");
  app.add_option("-j,--jobs", command.scene.jobs, "Threads; the result does not depend on it")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app.add_option("--report", command.report, "Write what was done as JSON")->type_name("FILE.json");
  app.set_config("--config", "", "Read options from a TOML file")->type_name("FILE");
  // A misspelt option in the file must not pass unnoticed.
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.add_flag("--dry-run", command.dry_run, "Read and check the inputs, write no pack");
  app.add_flag("--keep-going", command.keep_going, "Go on with the next input after an error");
  app.add_flag_callback(
      "-v,--verbose", [&command] { command.verbosity = Verbosity::kVerbose; }, "Say more");
  app.add_flag_callback(
      "-q,--quiet", [&command] { command.verbosity = Verbosity::kQuiet; }, "Only errors");
  app.set_version_flag("--version", "galactic-bake " GALACTIC_VERSION);
}

}  // namespace

ParsedCommand parseCommandLine(int argc, const char* const* argv) {
  CLI::App app("Bakes scene meshes into packs for galactic-run.", "galactic-bake");
  app.footer(kFooter);
  app.get_formatter()->column_width(34);
  BakeCommand command;
  RawOptions raw;
  command.scene.jobs = std::max(1U, std::thread::hardware_concurrency());
  addRunOptions(app, command);
  addGridOptions(app, raw, command);
  addImportOptions(app, raw);
  try {
    app.parse(argc, argv);
  } catch (const CLI::FileError& error) {
    fmt::print(stderr, "galactic-bake: --config: {}\n", error.what());
    return static_cast<int>(ErrorCode::kIo);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == kExitOk ? kExitOk : kExitUsage;
  }
  for (const auto& step : {understandImport(raw, command), understandScene(raw, command)}) {
    if (step) continue;
    fmt::print(stderr, "galactic-bake: {}: {}\n", step.error().where, step.error().message);
    return kExitUsage;
  }
  command.config = app.get_config_ptr()->as<std::string>();
  rememberContentOptions(raw, command);
  return command;
}

}  // namespace galactic::bake
