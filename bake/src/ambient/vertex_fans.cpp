#include "ambient/vertex_fans.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

namespace galactic::bake {
namespace {

using Vector = std::array<double, 3>;

constexpr double kCosineOfSmoothness = 0.8660254037844387;  // cosine of 30 degrees

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector difference(const Vec3& a, const Vec3& b) {
  return {static_cast<double>(a.x) - static_cast<double>(b.x),
          static_cast<double>(a.y) - static_cast<double>(b.y),
          static_cast<double>(a.z) - static_cast<double>(b.z)};
}

/// An ordered key that is equal for equal positions (0 equals -0).
std::array<std::uint32_t, 3> placeKey(const Vec3& p) {
  return {std::bit_cast<std::uint32_t>(p.x + 0.F), std::bit_cast<std::uint32_t>(p.y + 0.F),
          std::bit_cast<std::uint32_t>(p.z + 0.F)};
}

/// A corner of a triangle, with its vertex and position.
struct Corner {
  std::array<std::uint32_t, 3> place{};
  std::uint32_t vertex = 0;
  FanTriangle triangle;
};

/// The corners of triangles with nonzero area, sorted by position, then by triangle.
std::vector<Corner> sortedCorners(std::span<const Vec3> positions,
                                  std::span<const Triangle> triangles,
                                  std::span<const double> areas) {
  std::vector<Corner> corners;
  corners.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (!(areas[t] > 0)) continue;
    for (std::uint32_t c = 0; c < 3; ++c) {
      const std::uint32_t vertex = triangles[t][c];
      corners.push_back({placeKey(positions[vertex]), vertex, {.triangle = t, .corner = c}});
    }
  }
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return std::tie(a.place, a.triangle.triangle, a.triangle.corner) <
           std::tie(b.place, b.triangle.triangle, b.triangle.corner);
  });
  return corners;
}

}  // namespace

VertexFans::VertexFans(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  measure(positions, triangles);
  const std::vector<Corner> corners = sortedCorners(positions, triangles, areas_);
  // The mean normal of each vertex's own triangles.
  std::vector<Vector> own(positions.size(), Vector{});
  for (const Corner& corner : corners) {
    const std::uint32_t t = corner.triangle.triangle;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      own[corner.vertex][axis] += normals_[t][axis] * areas_[t];
    }
  }
  struct Entry {
    std::uint32_t vertex;
    FanTriangle triangle;
  };
  std::vector<Entry> found;
  found.reserve(2 * corners.size());
  for (std::size_t begin = 0; begin < corners.size();) {
    std::size_t end = begin;
    while (end < corners.size() && corners[end].place == corners[begin].place) ++end;
    const std::span place(&corners[begin], end - begin);
    std::vector<std::uint32_t> vertices;
    vertices.reserve(place.size());
    for (const Corner& corner : place) vertices.push_back(corner.vertex);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const std::uint32_t vertex : vertices) {
      const double length = std::sqrt(dot(own[vertex], own[vertex]));
      for (const Corner& corner : place) {
        const double cosine = dot(normals_[corner.triangle.triangle], own[vertex]);
        if (corner.vertex == vertex || cosine > kCosineOfSmoothness * length) {
          found.push_back({vertex, corner.triangle});
        }
      }
    }
    begin = end;
  }
  begins_.assign(positions.size() + 1, 0);
  for (const Entry& entry : found) ++begins_[entry.vertex + 1];
  for (std::size_t v = 0; v < positions.size(); ++v) begins_[v + 1] += begins_[v];
  entries_.resize(found.size());
  std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
  for (const Entry& entry : found) entries_[next[entry.vertex]++] = entry.triangle;
}

void VertexFans::measure(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  normals_.resize(triangles.size());
  areas_.resize(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3& origin = positions[triangles[t][0]];
    const Vector a = difference(positions[triangles[t][1]], origin);
    const Vector b = difference(positions[triangles[t][2]], origin);
    const Vector cross{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                       a[0] * b[1] - a[1] * b[0]};
    const double length = std::sqrt(dot(cross, cross));
    if (!(length > 0) || !std::isfinite(length)) continue;
    areas_[t] = length / 2;
    normals_[t] = {cross[0] / length, cross[1] / length, cross[2] / length};
  }
}

}  // namespace galactic::bake
