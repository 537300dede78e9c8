// Beams against marching in fine steps and in double precision, and both kernels against each
// other.
#include "sensors/scan_kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "scattered_grid.h"
#include "sensors/scan_plane.h"
#include "support/oracles/resting_oracle.h"
#include "support/processor.h"

namespace galactic::test::scan_kernels_test {
namespace {

using sensors::BeamBatch;
using sensors::ScanKernels;
using sensors::ScanPlane;
using simulation::RestingBox;

constexpr std::uint32_t kSeed = 20261;
constexpr std::size_t kBeams = 24;
/// In cells: each border on the way adds a nudge of 1/1024, and coordinates are floats.
constexpr double kRounding = 0.01;

/// Beams in random directions, some along the axes, from a point.
struct Fan {
  Fan(std::mt19937& random, const Vec3& origin, float range) {
    for (std::size_t n = 0; n < kBeams; ++n) {
      const double angle = random() % 8 == 0
                               ? 1.5707963267948966 * static_cast<double>(random() % 4)
                               : static_cast<double>(uniformIn(random, -4, 4));
      ahead[n] = static_cast<float>(std::cos(angle));
      right[n] = static_cast<float>(-std::sin(angle));
    }
    const float yaw = random() % 4 == 0 ? 0 : uniformIn(random, -3, 3);
    batch = {origin, std::cos(yaw), std::sin(yaw), ahead.data(), right.data(), kBeams, range};
  }

  /// World direction of a beam.
  [[nodiscard]] std::array<double, 2> direction(std::size_t n) const {
    const auto c = static_cast<double>(batch.cosine);
    const auto s = static_cast<double>(batch.sine);
    const auto a = static_cast<double>(ahead[n]);
    const auto r = static_cast<double>(right[n]);
    return {c * a + s * r, c * r - s * a};
  }

  std::array<float, kBeams> ahead{};
  std::array<float, kBeams> right{};
  BeamBatch batch;
};

/// Whether a point, in cells of the grid, lies in a blocked cell that is made smaller on all sides
/// by `shrink` (negative: larger).
bool isInBlocked(const ScatteredGrid& grid, double x, double z, double shrink) {
  const auto i = static_cast<std::int64_t>(std::floor(x));
  const auto k = static_cast<std::int64_t>(std::floor(z));
  for (std::int64_t b = k - 1; b <= k + 1; ++b) {
    for (std::int64_t a = i - 1; a <= i + 1; ++a) {
      const auto left = static_cast<double>(a) + shrink;
      const auto low = static_cast<double>(b) + shrink;
      const double edge = 1 - 2 * shrink;
      const bool inside = x >= left && x <= left + edge && z >= low && z <= low + edge;
      if (inside && grid.isBlocked(a, b)) return true;
    }
  }
  return false;
}

TEST(ScanKernels, EndBeamsWhereMarchingMeetsABlockedCell) {
  RecordProperty("seed", static_cast<int>(kSeed));
  std::mt19937 random(kSeed);
  const ScanKernels kernels = sensors::portableScan();
  constexpr double kSpacing = static_cast<double>(ScatteredGrid::kSpacing);
  constexpr float kRange = 1;
  int met = 0;
  int beams = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const ScatteredGrid grid(seed, 60, 50);
    const ScanPlane plane(grid.view(), {kCutHeight, kCutHeight});
    for (int place = 0; place < 12; ++place) {
      const Vec3 origin{uniformIn(random, -0.5F, 1.37F), kCutHeight,
                        uniformIn(random, 0.25F, 1.8F)};
      const Fan fan(random, origin, kRange);
      std::array<float, kBeams> distances{};
      kernels.cast_scene(plane.view(), fan.batch, distances.data());
      const double from_x = static_cast<double>(origin.x - ScatteredGrid::kMinX) / kSpacing;
      const double from_z = static_cast<double>(origin.z - ScatteredGrid::kMinZ) / kSpacing;
      for (std::size_t n = 0; n < kBeams; ++n) {
        const auto [x, z] = fan.direction(n);
        const double end = static_cast<double>(distances[n]) / kSpacing;
        ASSERT_GE(distances[n], 0);
        ASSERT_LE(distances[n], kRange);
        ++beams;
        // Nothing on the way there, but for corners that are cut by a nudge.
        for (double way = 0; way < end - kRounding; way += 1.0 / 64) {
          ASSERT_FALSE(isInBlocked(grid, from_x + way * x, from_z + way * z, kRounding))
              << "seed " << seed << " beam " << n << " at " << way << " of " << end;
        }
        if (distances[n] == kRange) continue;
        ++met;
        ASSERT_TRUE(isInBlocked(grid, from_x + end * x, from_z + end * z, -kRounding))
            << "seed " << seed << " beam " << n << " ends at " << end;
      }
    }
  }
  EXPECT_GT(10 * met, beams);
  EXPECT_LT(10 * met, 9 * beams);
}

RestingBox randomBox(std::mt19937& random, const Vec3& around) {
  OrientedBox box;
  box.half_extents = {uniformIn(random, 0.02F, 0.3F), uniformIn(random, 0.02F, 0.3F),
                      uniformIn(random, 0.02F, 0.3F)};
  Pose pose;
  pose.translation = {around.x + uniformIn(random, -0.7F, 0.7F),
                      around.y + uniformIn(random, -0.2F, 0.2F),
                      around.z + uniformIn(random, -0.7F, 0.7F)};
  pose.rotation =
      random() % 2 == 0 ? yaw(static_cast<double>(uniformIn(random, -3, 3))) : randomQuat(random);
  return simulation::restingBox(box, pose);
}

/// How deep a point is in a box, meters; negative outside.
double depthIn(const RestingBox& box, const Point3& point) {
  const Point3 center = toPoint3(box.center);
  const auto depth = [&](const Vec3& axis, float half) {
    const Point3 a = toPoint3(axis);
    double along = 0;
    for (std::size_t n = 0; n < 3; ++n) along += a[n] * (point[n] - center[n]);
    return static_cast<double>(half) - std::abs(along);
  };
  return std::min({depth(box.axis_x, box.half_extents.x), depth(box.axis_y, box.half_extents.y),
                   depth(box.axis_z, box.half_extents.z)});
}

TEST(ScanKernels, EndBeamsInTheLargestHalls) {
  // From 2^14 cells on, a border plus a nudge of 2^-10 is the border again.
  constexpr std::int32_t kLong = 60'000;
  constexpr std::int32_t kWide = 26;
  std::vector<std::uint8_t> cells(std::size_t{kLong} * kWide + sensors::kReadBeyond, 0);
  for (std::size_t k = 1; k + 1 < kWide; ++k) {
    std::fill_n(cells.begin() + static_cast<std::ptrdiff_t>(k * kLong + 1), kLong - 2, 1);
  }
  const sensors::ScanPlaneView hall{.cells = cells.data(),
                                    .columns_x = kLong,
                                    .columns_z = kWide,
                                    .spacing = 1,
                                    .inverse_spacing = 1};
  std::array<float, sensors::kBeamLanes> ahead{};
  std::array<float, sensors::kBeamLanes> right{};
  for (std::size_t n = 0; n < ahead.size(); ++n) {
    const double angle = 1e-4 * static_cast<double>(n);
    ahead[n] = static_cast<float>(std::cos(angle));
    right[n] = static_cast<float>(std::sin(angle));
  }
  const BeamBatch beams{.origin = {2.3F, 0, 2.6F},
                        .ahead = ahead.data(),
                        .right = right.data(),
                        .count = ahead.size(),
                        .range = 1e6F};
  std::vector<ScanKernels> builds{sensors::portableScan()};
  if (detail::hasAvx2()) builds.push_back(sensors::avx2Scan());
  for (const ScanKernels& kernels : builds) {
    std::array<float, sensors::kBeamLanes> found{};
    kernels.cast_scene(hall, beams, found.data());
    for (std::size_t n = 0; n < found.size(); ++n) {
      const double to_end = (kLong - 1 - 2.3) / static_cast<double>(ahead[n]);
      const double to_side = n == 0 ? to_end : (kWide - 1 - 2.6) / static_cast<double>(right[n]);
      // Each border on the way adds a nudge.
      EXPECT_NEAR(static_cast<double>(found[n]), std::min(to_end, to_side), to_end / 200);
    }
  }
}

TEST(ScanKernels, EndBeamsWhereMarchingEntersABox) {
  std::mt19937 random(kSeed);
  const ScanKernels kernels = sensors::portableScan();
  constexpr float kRange = 1;
  /// Meters: floats through a rotation.
  constexpr double kTolerance = 1e-4;
  int met = 0;
  int inside = 0;
  int beams = 0;
  for (int round = 0; round < 400; ++round) {
    const Vec3 origin{uniformIn(random, -5, 5), uniformIn(random, 0, 1), uniformIn(random, -5, 5)};
    const RestingBox box = randomBox(random, origin);
    const Fan fan(random, origin, kRange);
    std::array<float, kBeams> distances{};
    distances.fill(kRange);
    kernels.cast_box(box, fan.batch, distances.data());
    for (std::size_t n = 0; n < kBeams; ++n) {
      const auto direction = fan.direction(n);
      const Point3 from = toPoint3(origin);
      const auto at = [&](double way) {
        return Point3{from[0] + way * direction[0], from[1], from[2] + way * direction[1]};
      };
      const auto end = static_cast<double>(distances[n]);
      ++beams;
      for (double way = 0; way < end; way += 1e-3) {
        ASSERT_LT(depthIn(box, at(way)), kTolerance) << "round " << round << " beam " << n;
      }
      if (distances[n] == kRange) continue;
      ++met;
      inside += end == 0 ? 1 : 0;
      ASSERT_GT(depthIn(box, at(end)), -kTolerance) << "round " << round << " beam " << n;
    }
  }
  EXPECT_GT(10 * met, beams);
  EXPECT_LT(10 * met, 9 * beams);
  EXPECT_GT(inside, beams / 100);
}

TEST(ScanKernels, LeaveWhatIsNearerThanABox) {
  const RestingBox box = simulation::restingBox({{}, {0.25F, 0.25F, 0.25F}}, {{1, 0, 0}, {}});
  std::array<float, 8> ahead{1, 1, 1, 1, -1, 0, 0, 1};
  std::array<float, 8> right{0, 0, 0, 0, 0, 1, -1, 0};
  const BeamBatch beams{{0, 0.125F, 0}, 1, 0, ahead.data(), right.data(), 8, 4};
  std::array<float, 8> distances{4, 0.5F, 0.75F, 2, 4, 4, 4, 0};
  const std::array<float, 8> wanted{0.75F, 0.5F, 0.75F, 0.75F, 4, 4, 4, 0};
  sensors::portableScan().cast_box(box, beams, distances.data());
  EXPECT_EQ(distances, wanted);
}

template <std::size_t N>
void expectSameBits(const std::array<float, N>& a, const std::array<float, N>& b) {
  ASSERT_EQ(std::memcmp(a.data(), b.data(), sizeof(a)), 0);
}

TEST(ScanKernels, AgreeBitForBit) {
  if (!detail::hasAvx2()) GTEST_SKIP() << "no AVX2";
  std::mt19937 random(kSeed);
  const ScanKernels one = sensors::portableScan();
  const ScanKernels eight = sensors::avx2Scan();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    const ScatteredGrid grid(seed, 7 + 11 * (seed % 7), 50);
    const ScanPlane plane(grid.view(), {kCutHeight, kCutHeight});
    for (int place = 0; place < 60; ++place) {
      Vec3 origin{uniformIn(random, -1, 3), kCutHeight, uniformIn(random, -0.5F, 2.5F)};
      // On a border of cells, outside, or nowhere.
      if (place % 5 == 0) origin.x = ScatteredGrid::kMinX + 8 * ScatteredGrid::kSpacing;
      if (place == 1) origin.x = kNan;
      if (place == 2) origin.z = kInfinity;
      if (place == 3) origin.x = -1e30F;
      Fan fan(random, origin, place % 3 == 0 ? 0.3F : 10.0F);
      if (place == 4) fan.ahead[3] = kNan;
      // Both loops of the kernel: sixteen beams, and eight.
      fan.batch.count = place % 2 == 0 ? kBeams : 8;
      std::array<float, kBeams> wanted{};
      std::array<float, kBeams> found{};
      one.cast_scene(plane.view(), fan.batch, wanted.data());
      eight.cast_scene(plane.view(), fan.batch, found.data());
      expectSameBits(found, wanted);
      for (int boxes = 0; boxes < 4; ++boxes) {
        const RestingBox box = randomBox(random, origin);
        one.cast_box(box, fan.batch, wanted.data());
        eight.cast_box(box, fan.batch, found.data());
        expectSameBits(found, wanted);
      }
    }
  }
}

}  // namespace
}  // namespace galactic::test::scan_kernels_test
