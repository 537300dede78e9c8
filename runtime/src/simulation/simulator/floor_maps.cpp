#include "simulation/simulator/floor_maps.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "simulation/collision/floor_clearance.h"
#include "simulation/collision/floor_query.h"
#include "simulation/ways_out/floor_slices.h"
#include "support/threads/workers.h"

namespace galactic::simulation {
namespace {

/// Starts whose heights differ by no more than this are on the same floor, maybe on rugs. Meters.
constexpr float kUnevenness = 0.03F;

/// A floor of a scene, and the range of its starts in the order of sortedStarts().
struct Storey {
  std::uint32_t scene = 0;
  /// The base of the lowest of its starts.
  Vec3 start;
  std::size_t first = 0;
  std::size_t end = 0;
};

/// All maps of a floor.
struct FloorMaps {
  FloorClearance clearance;
  FloorSlices slices;
  LevelFloor level;
};

std::uint32_t sceneOf(const Model& model, std::uint32_t start) {
  return model.world->sceneIndexOf(model.episodeOf(start));
}

/// The starts sorted by scene, then from the lowest to the highest.
std::vector<std::uint32_t> sortedStarts(const Model& model) {
  std::vector<std::uint32_t> order(model.starts.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple(sceneOf(model, a), model.starts[a].base.y, a) <
           std::tuple(sceneOf(model, b), model.starts[b].base.y, b);
  });
  return order;
}

std::vector<Storey> storeysOf(const Model& model, std::span<const std::uint32_t> order) {
  std::vector<Storey> storeys;
  for (std::size_t n = 0; n < order.size(); ++n) {
    const std::uint32_t scene = sceneOf(model, order[n]);
    const Vec3& base = model.starts[order[n]].base;
    if (storeys.empty() || scene != storeys.back().scene ||
        base.y > storeys.back().start.y + kUnevenness) {
      storeys.push_back({.scene = scene, .start = base, .first = n});
    }
    storeys.back().end = n + 1;
  }
  return storeys;
}

/// For each radius the height of its lowest sphere center above the floor if all its spheres are
/// fixed to the robot's root, and so never change their height; otherwise 0.
std::vector<float> lowestOfRadius(const Model& model) {
  std::vector<float> lowest(model.world->radii().size());
  for (const RadiusRange& range : model.motion.ranges) {
    const auto spheres = std::span(model.motion.spheres).subspan(range.first, range.count);
    const auto is_fixed = [](const BodySphere& sphere) { return sphere.node < 0; };
    if (!std::ranges::all_of(spheres, is_fixed)) continue;
    const auto height = [](const BodySphere& sphere) { return sphere.center.y; };
    lowest[range.radius_index] =
        model.motion.base.root_height + height(*std::ranges::min_element(spheres, {}, height));
  }
  return lowest;
}

LevelFloor levelFloorOf(const Scene& scene, const Vec3& start, const GroundOptions& options) {
  return makeLevelFloor(scene.grids().front(), start, [&](const Vec3& at, float height) {
    const FloorUnder under = floorUnder(scene, {at.x, height, at.z}, options);
    return under.floor == Floor::kCarries ? under.height : std::numeric_limits<float>::quiet_NaN();
  });
}

FloorMaps mapsOf(const Storey& storey, const HeightsOverFloor& heights,
                 std::span<const float> lowest_of_radius, const Model& model) {
  // A held object may be higher than the robot was at any start.
  constexpr float kOverRobot = 0.25F;
  // A raised arm may be higher still, and slices have to cover it. Maps that reached as high would
  // know less further down.
  constexpr float kRaisedArm = 0.75F;
  const Scene& scene = model.scenes[storey.scene];
  const float floor = storey.start.y;
  return {.clearance =
              makeFloorClearance(scene, floor, kUnevenness,
                                 {heights.lowest, heights.highest + kOverRobot}, lowest_of_radius),
          .slices = makeFloorSlices(scene, floor, {heights.lowest, heights.highest + kRaisedArm},
                                    lowest_of_radius),
          .level = levelFloorOf(scene, storey.start, model.options.ground)};
}

}  // namespace

void mapFloors(const HeightsOverFloor& heights, Model& model) {
  const std::vector<std::uint32_t> order = sortedStarts(model);
  const std::vector<Storey> storeys = storeysOf(model, order);
  const std::vector<float> lowest_of_radius = lowestOfRadius(model);
  std::size_t cells = 0;
  for (const Storey& storey : storeys) cells += clearanceCells(model.scenes[storey.scene]);
  model.clearance.reserve(cells);
  // Enough at a time that no thread waits long for the others, but so few that maps not yet added
  // to the model need little memory.
  const std::uint32_t threads = detail::threadCount(model.options.threads);
  const std::size_t at_a_time = std::size_t{8} * threads;
  for (std::size_t first = 0; first < storeys.size(); first += at_a_time) {
    const std::span some =
        std::span(storeys).subspan(first, std::min(at_a_time, storeys.size() - first));
    // If the maps have no room left, robots ask the columns themselves.
    std::vector<std::optional<FloorMaps>> maps(some.size());
    detail::forEachPart(threads, some.size(), [&](std::size_t n) {
      if (!model.clearance.hasRoomFor(clearanceCells(model.scenes[some[n].scene]))) return;
      maps[n] = mapsOf(some[n], heights, lowest_of_radius, model);
    });
    for (std::size_t n = 0; n < some.size(); ++n) {
      if (!maps[n]) continue;
      const std::uint32_t map = model.clearance.add(maps[n]->clearance);
      if (map == kNoClearanceMap) continue;
      model.slices.add(maps[n]->slices);
      model.level_floors.add(maps[n]->level);
      for (std::size_t start = some[n].first; start < some[n].end; ++start) {
        model.starts[order[start]].clearance_map = map;
      }
    }
  }
}

}  // namespace galactic::simulation
