#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "galactic/column_grid.h"

namespace galactic {

/// The grids of one scene, by ascending radius.
using SceneGrids = std::vector<ColumnGrid>;

/// Spheres of one radius in one scene that are queried together.
struct QueryGroup {
  std::uint32_t scene = 0;
  std::uint32_t grid = 0;
  /// Range of the group in the workload's coordinates.
  std::size_t first = 0;
  std::size_t count = 0;
};

/// A fixed sequence of queries, made before any time is measured. Coordinates are in the world
/// frame.
struct QueryWorkload {
  std::string name;
  std::vector<float> x, y, z;
  std::vector<QueryGroup> groups;
  /// Number of spheres that exist at a time; sphere n is queried again at query n + spheres. 0 if
  /// the queries are unrelated.
  std::size_t spheres = 0;
  /// Spheres in the longest group.
  std::size_t longest = 0;

  [[nodiscard]] SphereCenters centers(const QueryGroup& group) const {
    const auto part = [&](const std::vector<float>& all) {
      return std::span(all).subspan(group.first, group.count);
    };
    return {part(x), part(y), part(z)};
  }
};

/// `robots` robots of 40 spheres (16 of the smallest radius on the hand, 16 of the middle one along
/// the arm, 8 of the largest one up the body), spread over the free space of the scenes, each
/// moving at most 2 cm per step for `steps` steps. Each scene must have at least one grid. The same
/// seed gives the same workload.
[[nodiscard]] QueryWorkload coherentWorkload(std::span<const SceneGrids> scenes,
                                             std::uint32_t robots, std::uint32_t steps,
                                             std::uint32_t seed);

/// Groups of 8 spheres at random places of random grids.
[[nodiscard]] QueryWorkload randomWorkload(std::span<const SceneGrids> scenes, std::uint32_t groups,
                                           std::uint32_t seed);

}  // namespace galactic
