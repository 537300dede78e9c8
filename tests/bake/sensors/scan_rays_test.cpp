// Scans of the sample apartment and rays in it, against rays through its triangles.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "engines/triangle_rays.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/ray_caster.h"
#include "sensors/scan_kernels.h"
#include "sensors/scan_plane.h"
#include "support/build_paths.h"
#include "support/homes/sample_world.h"

namespace galactic::test::scan_rays_test {
namespace {

using bake::TriangleRays;

constexpr std::uint32_t kSeed = 33;
constexpr std::size_t kBeams = 32;
constexpr float kRange = 6;
/// Meters. A cell is blocked when a triangle comes within 15 mm of the column in its middle: the
/// beam ends at its edge, at most half the diagonal of a cell of 3 cm further away.
constexpr float kAround = 0.015F + 0.0213F + 0.001F;
/// A beam that crosses a surface in the corner of a free cell ends in the next one, a diagonal on.
constexpr float kLate = 0.0425F + 0.001F;
/// Along the beam, how far scan and ray may be apart where a surface is met steeply.
constexpr float kSteep = 0.06F;

TriangleRays apartmentRays() {
  const auto asset =
      MemoryPack::opened(bake::importMesh(test::sourceFolder() / "packs/sample/apartment.glb"));
  auto clean = MemoryPack::opened(bake::placeAndClean(asset));
  return TriangleRays::build(std::move(clean.mesh.vertices), std::move(clean.mesh.triangles), 2)
      .value();
}

/// Whether a triangle comes near to a point, as short rays in many directions tell.
bool isAnythingNear(const TriangleRays& rays, const Vec3& point) {
  constexpr int kRays = 200;
  for (int n = 0; n < kRays; ++n) {
    // A spiral of evenly spread directions.
    const float y = 1 - 2 * (static_cast<float>(n) + 0.5F) / kRays;
    const float across = std::sqrt(1 - y * y);
    const float angle = 2.3999632F * static_cast<float>(n);
    const Vec3 direction{across * std::cos(angle), y, across * std::sin(angle)};
    if (!rays.isOpen(
            {.origin = point, .direction = direction, .nearest = 0, .farthest = 1.1F * kAround})) {
      return true;
    }
  }
  return false;
}

TEST(Scans, EndWhereRaysMeetTheScene) {
  RecordProperty("seed", static_cast<int>(kSeed));
  const MemoryPack pack = bakeSampleApartment();
  const Scene scene = Scene::from(pack.pack()).value();
  const ColumnGrid& grid = scene.grids().front();
  const TriangleRays rays = apartmentRays();
  const sensors::ScanKernels kernels = sensors::scanKernels();
  std::mt19937 random(kSeed);
  std::array<float, kBeams> ahead{};
  std::array<float, kBeams> right{};
  for (std::size_t n = 0; n < kBeams; ++n) {
    const double angle = 6.283185307179586 * static_cast<double>(n) / kBeams;
    ahead[n] = static_cast<float>(std::cos(angle));
    right[n] = static_cast<float>(-std::sin(angle));
  }
  int beams = 0;
  int open = 0;
  int met = 0;
  int late = 0;
  int unfounded = 0;
  int steep = 0;
  for (const float height : {0.25F, 0.8F}) {
    const sensors::ScanPlane plane(grid, {height, height});
    for (int place = 0; place < 120;) {
      std::uniform_real_distribution<float> share(0, 1);
      const ColumnGridLayout& layout = grid.layout();
      const Vec3 origin{
          layout.min_x + share(random) * static_cast<float>(layout.columns_x) * layout.spacing,
          height,
          layout.min_z + share(random) * static_cast<float>(layout.columns_z) * layout.spacing};
      // Where a robot may stand.
      if (scene.grids().back().clearance(origin) != Clearance::kFree) continue;
      ++place;
      std::array<float, kBeams> distances{};
      kernels.cast_scene(plane.view(), {origin, 1, 0, ahead.data(), right.data(), kBeams, kRange},
                         distances.data());
      for (std::size_t n = 0; n < kBeams; ++n) {
        const Vec3 direction{ahead[n], 0, right[n]};
        const float ray = rays.first({.origin = origin, .direction = direction}).value_or(kRange);
        ++beams;
        late += distances[n] > std::min(ray, kRange) + kLate ? 1 : 0;
        if (distances[n] == kRange) {
          ++open;
          continue;
        }
        ++met;
        unfounded += isAnythingNear(rays, origin + direction * distances[n]) ? 0 : 1;
        steep += std::fabs(distances[n] - ray) < kSteep ? 1 : 0;
      }
    }
  }
  std::printf("beams %d open %d late %d unfounded %d within %.0f mm of the ray %d\n", beams, open,
              late, unfounded, 1000 * static_cast<double>(kSteep), steep);
  EXPECT_GT(met, beams / 10);
  // Slivers between two columns, and the edges of thin things, are met or missed.
  EXPECT_LT(late, beams / 200);
  EXPECT_LT(unfounded, met / 200);
  // The others are met at a grazing angle, or pass close by.
  EXPECT_GT(steep, 17 * met / 20);
}

/// The same in all directions, where level surfaces are met 15 mm before.
TEST(Rays, EndWhereTheMeshIs) {
  RecordProperty("seed", static_cast<int>(kSeed));
  const MemoryPack pack = bakeSampleApartment();
  const Scene scene = Scene::from(pack.pack()).value();
  const TriangleRays triangles = apartmentRays();
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> share(0, 1);
  constexpr std::size_t kRays = 8000;
  const ColumnGridLayout& layout = scene.grids().front().layout();
  std::vector<Vec3> origins;
  std::vector<Vec3> directions;
  while (origins.size() < kRays) {
    const Vec3 origin{
        layout.min_x + share(random) * static_cast<float>(layout.columns_x) * layout.spacing,
        layout.heights.lo + share(random) * (layout.heights.hi - layout.heights.lo),
        layout.min_z + share(random) * static_cast<float>(layout.columns_z) * layout.spacing};
    if (scene.grids().back().clearance(origin) != Clearance::kFree) continue;
    origins.push_back(origin);
    const float y = 2 * share(random) - 1;
    const float across = std::sqrt(1 - y * y);
    const float angle = 6.2831853F * share(random);
    directions.push_back({across * std::cos(angle), y, across * std::sin(angle)});
  }
  std::vector<CastHit> hits(kRays);
  RayCaster(scene).castRays({origins, directions, std::vector<float>(kRays, kRange)}, hits, 2);
  int met = 0;
  int late = 0;
  int unfounded = 0;
  int steep = 0;
  for (std::size_t n = 0; n < kRays; ++n) {
    const float distance = hits[n].distance;
    const float ray =
        triangles.first({.origin = origins[n], .direction = directions[n]}).value_or(kRange);
    late += distance > std::min(ray, kRange) + kLate ? 1 : 0;
    if (hits[n].end != CastEnd::kScene) continue;
    ++met;
    unfounded += isAnythingNear(triangles, origins[n] + directions[n] * distance) ? 0 : 1;
    steep += std::fabs(distance - ray) < kSteep ? 1 : 0;
  }
  std::printf("rays %zu met %d late %d unfounded %d within %.0f mm of the mesh %d\n", kRays, met,
              late, unfounded, 1000 * static_cast<double>(kSteep), steep);
  const auto count = static_cast<int>(kRays);
  EXPECT_GT(met, count / 2);
  EXPECT_LT(late, count / 200);
  EXPECT_LT(unfounded, met / 200);
  EXPECT_GT(steep, 17 * met / 20);
}

}  // namespace
}  // namespace galactic::test::scan_rays_test
