#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "galactic/pose.h"
#include "galactic/scene.h"
#include "galactic/simulation_options.h"

namespace galactic::simulation {

/// What the floor under a base allows.
enum class Floor : std::uint8_t {
  kCarries = 0,
  /// Higher than the base may climb, or no height for it.
  kBlocks = 1,
  /// Deeper than the base may drop, or unknown.
  kDrops = 2,
};

struct FloorUnder {
  Floor floor = Floor::kDrops;
  /// Of the floor; where it does not carry, that of the base.
  float height = 0;
};

/// What is under a base at `base` (its y: the floor it comes from).
[[nodiscard]] FloorUnder floorUnder(const Scene& scene, const Vec3& base,
                                    const GroundOptions& options) noexcept;

/// The same at a start: episodes may begin up to half a meter above their floor.
[[nodiscard]] FloorUnder floorUnderStart(const Scene& scene, const Vec3& start,
                                         const GroundOptions& options) noexcept;

/// Bases in one query.
inline constexpr std::size_t kMostBases = 16;

/// What is under each of `bases`, kMostBases at most: one batched query, so that none waits for
/// what another one asks the memory for. Shape of `under`: as many.
void floorsUnder(const Scene& scene, std::span<const Vec3> bases, const GroundOptions& options,
                 std::span<FloorUnder> under) noexcept;

/// Of a base under which there is no floor: the smallest sphere of the working set, standing on a
/// rise as high as the base may climb or, where that is too high for the room at `before`, where it
/// was, as high as by default. Where it is free there is a floor under it.
[[nodiscard]] Vec3 floorProbe(const Scene& scene, const Vec3& base, const Vec3& before,
                              const GroundOptions& options) noexcept;

}  // namespace galactic::simulation
