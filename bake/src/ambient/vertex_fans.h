#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// A triangle as one of its corners sees it.
struct FanTriangle {
  std::uint32_t triangle = 0;
  /// Which corner of the triangle the vertex is, 0 to 2.
  std::uint32_t corner = 0;
};

/// For each vertex of a mesh, the triangles that count for it: its own, and those of other vertices
/// at the same position whose normals are less than 30 degrees from the vertex's own. Ascending,
/// without triangles of zero area.
class VertexFans {
 public:
  /// `triangles` index `positions`; positions that no triangle uses may be anything.
  VertexFans(std::span<const Vec3> positions, std::span<const Triangle> triangles);

  [[nodiscard]] std::span<const FanTriangle> of(std::size_t vertex) const {
    return std::span(entries_).subspan(begins_[vertex], begins_[vertex + 1] - begins_[vertex]);
  }
  /// Unit normal of a triangle; area() is in square meters, 0 for a degenerate triangle.
  [[nodiscard]] const std::array<double, 3>& normal(std::size_t triangle) const {
    return normals_[triangle];
  }
  [[nodiscard]] double area(std::size_t triangle) const { return areas_[triangle]; }

 private:
  void measure(std::span<const Vec3> positions, std::span<const Triangle> triangles);

  std::vector<std::array<double, 3>> normals_;
  std::vector<double> areas_;
  std::vector<FanTriangle> entries_;
  std::vector<std::size_t> begins_;
};

}  // namespace galactic::bake
