#include "galactic/bake/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "common/overload.h"

namespace galactic::bake {
namespace {

/// Number of the largest parts of the free space that are listed individually.
constexpr std::size_t kLargestParts = 8;

RenderFigures figuresOf(const BakedRenderMeshes& meshes) {
  RenderFigures figures{.all = meshes.statistics(), .textures = meshes.materials.textures.size()};
  if (meshes.materials.shared) {
    auto& hashes = figures.shared_textures.emplace();
    for (const BakedTexture& texture : meshes.materials.textures) {
      hashes.push_back(textureHash(texture));
    }
  }
  for (const RenderModel& model : meshes.models) {
    figures.models.push_back({.part = model.part,
                              .step = model.step,
                              .source_triangles = model.source_triangles,
                              .triangles = model.triangles,
                              .clusters = model.cluster_count,
                              .largest_error = model.largest_error});
  }
  return figures;
}

std::optional<RenderFigures> figuresOf(const std::optional<BakedRenderMeshes>& meshes) {
  if (!meshes) return std::nullopt;
  return figuresOf(*meshes);
}

GridFigures figuresOf(const BakedGrid& baked) {
  const EncodedGrid& grid = baked.grid;
  GridFigures figures{.radius = grid.frame.radius,
                      .spacing = grid.frame.spacing,
                      .columns = {grid.frame.columns_x, grid.frame.columns_z},
                      .raw_spans = baked.raw_spans,
                      .spans = grid.spans,
                      .max_spans_per_column = grid.max_spans_per_column,
                      .overflow_columns = grid.overflow_columns,
                      .merged_gaps = baked.merged_gaps,
                      .slivers = grid.slivers,
                      .stored_bytes = storedBytes(grid),
                      .regions = baked.totals,
                      .cast_check = baked.cast_check,
                      .parts = baked.components.size()};
  for (std::size_t n = 0; n < std::min(kLargestParts, baked.components.size()); ++n) {
    const Component& part = baked.components[n];
    figures.largest_parts.push_back({part.region, part.volume, part.bounds});
  }
  return figures;
}

SceneFigures figuresOf(const SceneOutcome& outcome) {
  const BakedScene& scene = outcome.scene;
  SceneFigures figures{.input = outcome.input.string(),
                       .imported = scene.imported,
                       .convention = outcome.convention,
                       .bounds = scene.bounds,
                       .seconds = outcome.times,
                       .warnings = scene.warnings,
                       .render_meshes = figuresOf(scene.render_meshes)};
  for (const BakedGrid& grid : scene.grids) figures.grids.push_back(figuresOf(grid));
  return figures;
}

SphereFigures figuresOf(const SphereSet& set, std::size_t radii) {
  SphereFigures figures{.count = set.spheres.size(),
                        .count_per_radius = std::vector<std::uint64_t>(radii),
                        .quality = set.quality,
                        .guaranteed_gap = set.guaranteed_gap,
                        .guaranteed_protrusion = set.guaranteed_protrusion,
                        .meets_tolerances = set.meets_tolerances};
  for (const SetSphere& sphere : set.spheres) ++figures.count_per_radius[sphere.radius_index];
  return figures;
}

ObjectSetFigures figuresOf(const ObjectSetOutcome& outcome) {
  ObjectSetFigures figures{
      .radii = outcome.radii, .warnings = outcome.warnings, .seconds = outcome.seconds};
  for (std::size_t n = 0; n < outcome.objects.size(); ++n) {
    const BakedObject& object = outcome.objects[n];
    figures.objects.push_back({.input = outcome.origins[n].input.string(),
                               .name = object.name,
                               .imported = object.imported,
                               .box = object.box,
                               .authored_spheres = object.authored_spheres,
                               .spheres = figuresOf(object.spheres, outcome.radii.size()),
                               .stable_poses = object.stable_poses,
                               .seconds = {outcome.origins[n].import_seconds, object.times},
                               .render_meshes = figuresOf(object.render_meshes),
                               .warnings = object.warnings});
  }
  return figures;
}

RobotFigures figuresOf(const RobotOutcome& outcome) {
  const BakedRobot& robot = outcome.robot;
  RobotFigures figures{.input = outcome.input.string(),
                       .name = robot.name,
                       .links = robot.kinematics.links.size(),
                       .joint_positions = robot.kinematics.limits.size(),
                       .controlled_joints = robot.controlled_joints.size(),
                       .meshes = outcome.resolutions,
                       .seconds = {.import = outcome.import_seconds,
                                   .bake = robot.times,
                                   .write = outcome.write_seconds,
                                   .all = outcome.seconds},
                       .render_meshes = figuresOf(robot.render_meshes),
                       .warnings = robot.warnings};
  for (const BakedGroup& group : robot.groups) {
    std::vector<std::string> links;
    for (const std::uint32_t link : group.links) links.push_back(robot.link_names[link]);
    figures.groups.push_back({.link = robot.link_names[group.link],
                              .links = std::move(links),
                              .by_hand = group.authored,
                              .eps = group.eps,
                              .tau = group.tau,
                              .spheres = figuresOf(group.spheres, robot.radii.size()),
                              .is_measured = group.measured});
  }
  for (const BakedPair& pair : robot.pairs) {
    figures.pairs.push_back({robot.link_names[robot.groups[pair.first].link],
                             robot.link_names[robot.groups[pair.second].link], pair.kind});
  }
  return figures;
}

EpisodeFigures::Distances targetDistances(const SourceEpisodes& set) {
  EpisodeFigures::Distances distances;
  for (const Episode& episode : set.episodes) {
    const Vec3 start = set.placements[episode.first_placement + episode.target].pose.translation;
    const Vec3 way = episode.goal.translation - start;
    const double length = std::sqrt(static_cast<double>(dot(way, way)));
    const bool first = &episode == set.episodes.data();
    distances.min = first ? length : std::min(distances.min, length);
    distances.max = std::max(distances.max, length);
    distances.mean += length / static_cast<double>(set.episodes.size());
  }
  return distances;
}

EpisodeFigures figuresOf(const EpisodeOutcome& outcome) {
  const SourceEpisodes& set = outcome.episodes;
  std::uint64_t most = 0;
  for (const Episode& episode : set.episodes) {
    most = std::max<std::uint64_t>(most, episode.placement_count);
  }
  return {.input = outcome.input,
          .name = set.name,
          .robot = set.robot,
          .episodes = set.episodes.size(),
          .placements = set.placements.size(),
          .most_placements = most,
          .scenes = set.scenes,
          .objects = set.objects,
          .start_joints = set.start_joints,
          .target_to_goal = targetDistances(set),
          .seconds = outcome.seconds,
          .warnings = set.warnings,
          .generation = outcome.generation};
}

/// A warning if too few of the episodes that were tried can be solved. The pack does not store it,
/// because it is only about the sample.
std::vector<std::string> solveWarnings(const std::optional<EpisodeGeneration>& generation) {
  constexpr std::uint64_t kEnoughPercent = 80;
  constexpr std::uint64_t kAllPercent = 100;
  if (!generation) return {};
  const SolvedSample& sample = generation->sample;
  if (kAllPercent * sample.solved >= kEnoughPercent * sample.episodes) return {};
  return {
      fmt::format("the scripted policy solves {} of {} episodes, less than {} %: robot, "
                  "scenes and `heights` may not suit each other",
                  sample.solved, sample.episodes, kEnoughPercent)};
}

WorldFigures figuresOf(const WorldOutcome& outcome) { return {outcome.packs, outcome.seconds}; }

}  // namespace

PackFigures figuresOf(const BakedPack& made) {
  PackFigures figures{.output = made.output.string(), .pack_bytes = made.pack_bytes, .of = {}};
  std::visit([&](const auto& outcome) { figures.of = figuresOf(outcome); }, made.outcome);
  return figures;
}

std::vector<std::string> warningsOf(const PackFigures& figures) {
  return std::visit(
      Overload{[](const ObjectSetFigures& one) {
                 std::vector<std::string> all = one.warnings;
                 for (const ObjectFigures& object : one.objects) {
                   all.insert(all.end(), object.warnings.begin(), object.warnings.end());
                 }
                 return all;
               },
               [](const EpisodeFigures& one) {
                 std::vector<std::string> all = one.warnings;
                 std::ranges::move(solveWarnings(one.generation), std::back_inserter(all));
                 return all;
               },
               [](const WorldFigures&) { return std::vector<std::string>(); },
               [](const auto& one) { return one.warnings; }},
      figures.of);
}

std::vector<std::string> sharedTexturesOf(const PackFigures& figures) {
  const auto* scene = std::get_if<SceneFigures>(&figures.of);
  if (scene == nullptr || !scene->render_meshes) return {};
  return scene->render_meshes->shared_textures.value_or(std::vector<std::string>());
}

}  // namespace galactic::bake
