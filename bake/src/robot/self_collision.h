#pragma once
#include <vector>

#include "galactic/bake/robot_baker.h"

namespace galactic::bake {

/// Joint vectors tried to find out which groups can touch.
inline constexpr std::size_t kSelfCollisionSamples = 4000;

/// What each pair of groups with spheres does over the start pose and random joint vectors within
/// the limits (a full turn where there is none), from a fixed seed. Groups joined by a joint are
/// adjacent; `ignored` holds ascending pairs of links that may touch. Deterministic.
[[nodiscard]] std::vector<BakedPair> classifyPairs(
    const BakedRobot& robot, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& ignored);

}  // namespace galactic::bake
