#include "galactic/number_text.h"
#include "option_groups.h"
#include "option_values.h"

namespace galactic::bake {
namespace {

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

}  // namespace

void SceneOptions::addTo(CLI::App& app, BakeCommand& command) {
  SceneBakeOptions& scene = command.scene;
  app.add_option("--spacing", spacing_, "Edge of a cell, metres; at most twice the least radius")
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
  app.add_option("--keep", scene.free_space.keep, "What to store: the room, or all free spans")
      ->transform(CLI::CheckedTransformer(keepNames()))
      ->option_text("room|all");
  components_ = app.add_option("--keep-components", scene.free_space.components,
                               "Without seeds: how many of the largest free parts are the room")
                    ->check(wholeCheck(1, 1000000))
                    ->capture_default_str();
  app.add_option("--check-columns", scene.check_columns,
                 "Columns per grid to replay with sphere casts; 0: none")
      ->check(wholeCheck(0, 1000000))
      ->capture_default_str();
}

Result<void> SceneOptions::understand(BakeCommand& command, const std::vector<std::string>& seeds) {
  const auto spacing = parseExactly(spacing_, "--spacing", 1);
  if (!spacing) return tl::unexpected(spacing.error());
  command.scene.spacing = static_cast<float>((*spacing)[0]);
  if (command.kind == AssetKind::kScene) seeds_ = seeds;
  const bool has_components = components_->count() > 0;
  if (has_components && !seeds_.empty()) {
    return fail(ErrorCode::kInvalidInput, "--keep-components",
                "does not go with --seed, whose free parts are the room; leave one of them out");
  }
  if (command.scene.free_space.keep == Keep::kAll && (has_components || !seeds_.empty())) {
    return fail(ErrorCode::kInvalidInput, has_components ? "--keep-components" : "--seed",
                "says what the room is, and --keep all stores everything; leave one of them out");
  }
  for (const std::string& seed : seeds_) {
    const auto point = parseExactly(seed, "--seed", 3);
    if (!point) return tl::unexpected(point.error());
    command.scene.free_space.seeds.push_back({static_cast<float>((*point)[0]),
                                              static_cast<float>((*point)[1]),
                                              static_cast<float>((*point)[2])});
  }
  return {};
}

void SceneOptions::remember(BakeCommand& command) const {
  command.remember("spacing", spacing_);
  command.remember("engine", nameOf(engineNames(), command.scene.engine));
  command.remember("coverage", nameOf(coverageNames(), command.scene.coverage));
  command.remember("keep", nameOf(keepNames(), command.scene.free_space.keep));
  if (seeds_.empty()) {
    command.remember("keep-components", std::to_string(command.scene.free_space.components));
  }
  for (const std::string& seed : seeds_) command.remember("seed", seed);
  command.remember("check-columns", std::to_string(command.scene.check_columns));
}

}  // namespace galactic::bake
