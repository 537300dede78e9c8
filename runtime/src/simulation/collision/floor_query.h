#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "galactic/pose.h"
#include "galactic/scene.h"
#include "galactic/simulation_options.h"

namespace galactic::simulation {

/// Whether the floor under a base carries it, and why not.
enum class Floor : std::uint8_t {
  kCarries = 0,
  /// It is higher than the base may climb, or offers no height for it.
  kBlocks = 1,
  /// It is deeper than the base may drop, or unknown.
  kDrops = 2,
};

struct FloorUnder {
  Floor floor = Floor::kDrops;
  /// The floor's height, or the base's if the floor does not carry it.
  float height = 0;
};

/// The floor under a base at `base`, whose y is the height of the floor that it comes from.
[[nodiscard]] FloorUnder floorUnder(const Scene& scene, const Vec3& base,
                                    const GroundOptions& options) noexcept;

/// The same at a start: episodes may begin up to half a meter above their floor.
[[nodiscard]] FloorUnder floorUnderStart(const Scene& scene, const Vec3& start,
                                         const GroundOptions& options) noexcept;

/// The most bases in one query.
inline constexpr std::size_t kMostBases = 16;

/// The floor under each of `bases`, kMostBases at most: one batched query, so that none waits for
/// the memory loads of another. Shape of `under`: that of `bases`.
void floorsUnder(const Scene& scene, std::span<const Vec3> bases, const GroundOptions& options,
                 std::span<FloorUnder> under) noexcept;

/// The sphere center that has to become free for a base under which there is no floor: the smallest
/// sphere of the working set, standing on a rise as high as the base may climb. If there is no
/// headroom for that at `before`, where the base was, the rise is the default one. Wherever this
/// sphere is free, there is a floor under it.
[[nodiscard]] Vec3 floorProbe(const Scene& scene, const Vec3& base, const Vec3& before,
                              const GroundOptions& options) noexcept;

}  // namespace galactic::simulation
