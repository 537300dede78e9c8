#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>

#include "fit/convex_hull.h"

namespace galactic::bake::fit {
namespace {

/// A hash table of points with linear probing. Meshes repeat each vertex about six times, so
/// sorting all of them would take several times as long.
class PointTable {
 public:
  explicit PointTable(std::size_t count)
      : slots_(std::bit_ceil(2 * count + 1), kEmpty), mask_(slots_.size() - 1) {}

  void add(const Vec3& point) {
    for (std::size_t slot = hashOf(point) & mask_;; slot = (slot + 1) & mask_) {
      if (slots_[slot] == kEmpty) {
        slots_[slot] = static_cast<std::uint32_t>(points_.size());
        points_.push_back(point);
        return;
      }
      if (points_[slots_[slot]] == point) return;
    }
  }

  std::vector<Vec3>& points() { return points_; }

 private:
  static constexpr std::uint32_t kEmpty = ~0U;

  static std::size_t hashOf(const Vec3& point) {
    std::uint64_t hash = 0;
    for (const float part : {point.x, point.y, point.z}) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(part)) * 0x9e3779b97f4a7c15ULL;
      hash ^= hash >> 32U;
    }
    return static_cast<std::size_t>(hash);
  }

  std::vector<std::uint32_t> slots_;
  std::size_t mask_;
  std::vector<Vec3> points_;
};

}  // namespace

std::vector<Vec3> uniquePoints(std::span<const Vec3> points) {
  PointTable table(points.size());
  for (const Vec3& point : points) {
    // Adding zero turns a negative zero into a positive one, which has the same value.
    table.add({point.x + 0.0F, point.y + 0.0F, point.z + 0.0F});
  }
  std::vector<Vec3> unique = std::move(table.points());
  std::sort(unique.begin(), unique.end(), [](const Vec3& a, const Vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  });
  return unique;
}

}  // namespace galactic::bake::fit
