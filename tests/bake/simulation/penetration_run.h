#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "state_checker.h"

namespace galactic::test {

/// What a search for penetrations does.
struct PenetrationRun {
  /// The scene's mesh, Y up.
  std::filesystem::path mesh{};
  /// Published episodes in it; empty: generated ones.
  std::filesystem::path episodes{};
  std::uint32_t envs = 512;
  /// Of the whole batch.
  std::uint64_t steps = 1000;
  /// One env in so many is watched.
  std::uint32_t watched = 1;
  /// Bullet is asked about one state of theirs in so many; column grids and boxes about each.
  std::uint32_t sampled = 64;
  /// Of the actions.
  std::uint32_t seed = 801;
  /// SimulationOptions::continuous_collision.
  bool continuous = false;
};

struct PenetrationReport {
  Findings found;
  SimulationStatistics seen;
  std::size_t episodes = 0;
  std::size_t skipped = 0;
  /// Depth of the deepest sphere that Bullet found, computed in double over all triangles, meters.
  double deepest_exactly = 0;
};

/// Takes random steps in a home of the scene, with the objects and the robot of packs/sample, and
/// looks at every state that is accepted. Throws where the home cannot be made.
[[nodiscard]] PenetrationReport searchPenetrations(const PenetrationRun& run);

void print(const PenetrationReport& report);

}  // namespace galactic::test
