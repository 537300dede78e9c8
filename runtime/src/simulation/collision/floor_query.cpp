#include "simulation/collision/floor_query.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "galactic/column_grid.h"

namespace galactic::simulation {
namespace {

/// If a probe at a larger most_rise ends in a ceiling or outside of the grid, the floor is searched
/// from this height: the default most_rise.
constexpr float kLowRise = GroundOptions{}.most_rise;

/// The center of the smallest sphere, standing `rise` above a base.
Vec3 probeAbove(const Scene& scene, const Vec3& base, float rise) {
  return {base.x, base.y + rise + scene.grids().front().radius(), base.z};
}

/// Whether a probe found no floor, but a lower one might.
bool isTooHigh(Clearance clearance, const GroundOptions& options) {
  return clearance != Clearance::kFree && options.most_rise > kLowRise;
}

/// The floor that the probe found from height `probe`; `down`: how far the floor is below it.
FloorUnder floorFound(const ColumnGrid& grid, const Vec3& base, float probe, Clearance clearance,
                      float down, const GroundOptions& options) {
  if (clearance == Clearance::kBlocked) return {Floor::kBlocks, base.y};
  if (clearance == Clearance::kOutside) return {Floor::kDrops, base.y};
  const float height = probe - down - grid.radius();
  if (height < base.y - options.most_drop) return {Floor::kDrops, base.y};
  return {Floor::kCarries, height};
}

/// The floor that a probe finds from `rise` above a base.
FloorUnder lookDown(const Scene& scene, const Vec3& base, float rise,
                    const GroundOptions& options) {
  const ColumnGrid& grid = scene.grids().front();
  const Vec3 probe = probeAbove(scene, base, rise);
  const Contact contact = grid.contact(probe);
  if (rise > kLowRise && isTooHigh(contact.clearance, options)) {
    return lookDown(scene, base, kLowRise, options);
  }
  return floorFound(grid, base, probe.y, contact.clearance, contact.down, options);
}

}  // namespace

FloorUnder floorUnder(const Scene& scene, const Vec3& base, const GroundOptions& options) noexcept {
  return lookDown(scene, base, options.most_rise, options);
}

FloorUnder floorUnderStart(const Scene& scene, const Vec3& start,
                           const GroundOptions& options) noexcept {
  constexpr float kDeepestSearch = 0.5F;
  GroundOptions ground = options;
  ground.most_drop = std::max(ground.most_drop, kDeepestSearch);
  return floorUnder(scene, start, ground);
}

void floorsUnder(const Scene& scene, std::span<const Vec3> bases, const GroundOptions& options,
                 std::span<FloorUnder> under) noexcept {
  const std::size_t count = bases.size();
  assert(count <= kMostBases && under.size() == count);
  const ColumnGrid& grid = scene.grids().front();
  std::array<float, kMostBases> x;
  std::array<float, kMostBases> y;
  std::array<float, kMostBases> z;
  for (std::size_t n = 0; n < count; ++n) {
    const Vec3 probe = probeAbove(scene, bases[n], options.most_rise);
    x[n] = probe.x;
    y[n] = probe.y;
    z[n] = probe.z;
  }
  std::array<Clearance, kMostBases> clearance;
  std::array<float, kMostBases> down;
  std::array<float, kMostBases> up;
  grid.contact({std::span(x).first(count), std::span(y).first(count), std::span(z).first(count)},
               {std::span(clearance).first(count), std::span(down).first(count),
                std::span(up).first(count)});
  for (std::size_t n = 0; n < count; ++n) {
    under[n] = isTooHigh(clearance[n], options)
                   ? lookDown(scene, bases[n], kLowRise, options)
                   : floorFound(grid, bases[n], y[n], clearance[n], down[n], options);
  }
}

Vec3 floorProbe(const Scene& scene, const Vec3& base, const Vec3& before,
                const GroundOptions& options) noexcept {
  float rise = options.most_rise;
  if (rise > kLowRise) {
    // Under a low ceiling, no way out leads to a place where the higher probe is free.
    const Vec3 higher = probeAbove(scene, before, rise);
    if (isTooHigh(scene.grids().front().contact(higher).clearance, options)) rise = kLowRise;
  }
  return probeAbove(scene, base, rise);
}

}  // namespace galactic::simulation
