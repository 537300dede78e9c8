#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>

#include "galactic/pose.h"

namespace galactic::test {

/// A rotation in double precision: w, x, y, z; any length but zero.
using Rotation = std::array<double, 4>;

/// A double in [0, 1), the same with every standard library.
inline double uniform(std::mt19937& random) { return static_cast<double>(random()) / 4294967296.0; }

/// A rotation drawn evenly (Shoemake 1992).
inline Rotation randomRotation(std::mt19937& random) {
  constexpr double kTurn = 6.283185307179586;
  const double share = uniform(random);
  const double first = kTurn * uniform(random);
  const double second = kTurn * uniform(random);
  const double a = std::sqrt(1 - share);
  const double b = std::sqrt(share);
  return {a * std::sin(first), a * std::cos(first), b * std::sin(second), b * std::cos(second)};
}

/// The best box by trying: random rotations, each walked downhill in ever smaller steps. Knows
/// nothing of hulls, faces and calipers.
class BoxOracle {
 public:
  /// Looks at `points`, which must outlive it.
  explicit BoxOracle(std::span<const Vec3> points) : points_(points) {}

  /// Volume of the box whose axes are the rows of the rotation's matrix.
  [[nodiscard]] double volumeAt(const Rotation& q) const {
    const auto [w, x, y, z] = q;
    const double s = 2 / (w * w + x * x + y * y + z * z);
    const std::array<std::array<double, 3>, 3> rows{
        {{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
         {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
         {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}}};
    double volume = 1;
    for (const auto& row : rows) {
      double lo = std::numeric_limits<double>::infinity();
      double hi = -lo;
      for (const Vec3& point : points_) {
        const double here = row[0] * static_cast<double>(point.x) +
                            row[1] * static_cast<double>(point.y) +
                            row[2] * static_cast<double>(point.z);
        lo = std::min(lo, here);
        hi = std::max(hi, here);
      }
      volume *= hi - lo;
    }
    return volume;
  }

  /// The least volume found from a start: steps along the four parts of the quaternion, halved
  /// when none helps.
  [[nodiscard]] double descend(Rotation at) const {
    double best = volumeAt(at);
    constexpr int kHalvings = 18;
    double step = 0.2;
    for (int halving = 0; halving < kHalvings; ++halving, step /= 2) {
      bool improved = true;
      for (int round = 0; improved && round < 20; ++round) {
        improved = false;
        for (std::size_t part = 0; part < 4; ++part) {
          for (const double signed_step : {step, -step}) {
            Rotation next = at;
            next[part] += signed_step;
            const double volume = volumeAt(next);
            if (volume >= best) continue;
            best = volume;
            at = next;
            improved = true;
          }
        }
      }
    }
    return best;
  }

  /// The least volume over `starts` random starts.
  [[nodiscard]] double bestVolume(std::uint32_t seed, int starts) const {
    std::mt19937 random(seed);
    double best = std::numeric_limits<double>::infinity();
    for (int start = 0; start < starts; ++start) {
      best = std::min(best, descend(randomRotation(random)));
    }
    return best;
  }

 private:
  std::span<const Vec3> points_;
};

}  // namespace galactic::test
