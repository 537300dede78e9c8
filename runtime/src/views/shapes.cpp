#include "views/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace galactic::views {
namespace {

/// `color`, its brightness multiplied by `light`.
std::uint32_t dimmed(std::uint32_t color, float light) {
  std::uint32_t result = color & 0xFF000000U;
  for (const unsigned shift : {0U, 8U, 16U}) {
    const auto channel = static_cast<float>(color >> shift & 0xFFU);
    result |= static_cast<std::uint32_t>(std::lround(channel * light)) << shift;
  }
  return result;
}

/// The brightness of a ball where its normal is `normal`.
float lightOn(const Vec3& normal) {
  // Unit length.
  constexpr Vec3 kLight{0.36F, 0.8F, 0.48F};
  constexpr float kDarkest = 0.5F;
  return kDarkest + (1 - kDarkest) * (0.5F + 0.5F * dot(normal, kLight));
}

Vec3 unit(const Vec3& v) { return v * (1 / std::sqrt(dot(v, v))); }

/// An icosahedron. Each split() replaces every triangle by four, with their corners on the unit
/// sphere.
class Icosphere {
 public:
  Icosphere() {
    constexpr float kGolden = 1.61803399F;
    for (const float a : {-1.0F, 1.0F}) {
      for (const float b : {-kGolden, kGolden}) {
        points_.push_back(unit({a, b, 0}));
        points_.push_back(unit({0, a, b}));
        points_.push_back(unit({b, 0, a}));
      }
    }
    addFaces();
  }

  void split() {
    std::vector<std::array<std::uint32_t, 3>> finer;
    finer.reserve(4 * triangles_.size());
    for (const auto& [a, b, c] : triangles_) {
      const std::uint32_t ab = middle(a, b);
      const std::uint32_t bc = middle(b, c);
      const std::uint32_t ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles_ = std::move(finer);
    middles_.clear();
  }

  [[nodiscard]] const std::vector<Vec3>& points() const { return points_; }
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& triangles() const {
    return triangles_;
  }

 private:
  /// Adds the twenty triples of points that are neighbors of each other.
  void addFaces() {
    // Seen from the center, neighbors are 63 degrees apart, other points at least 116.
    constexpr float kBetween = 0.2F;
    const auto is_edge = [this](std::uint32_t a, std::uint32_t b) {
      return dot(points_[a], points_[b]) > kBetween;
    };
    for (std::uint32_t a = 0; a < points_.size(); ++a) {
      for (std::uint32_t b = a + 1; b < points_.size(); ++b) {
        for (std::uint32_t c = b + 1; c < points_.size(); ++c) {
          if (!is_edge(a, b) || !is_edge(b, c) || !is_edge(a, c)) continue;
          const bool is_outward = dot(cross(points_[a], points_[b]), points_[c]) > 0;
          triangles_.push_back(is_outward ? std::array{a, b, c} : std::array{a, c, b});
        }
      }
    }
  }

  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    const auto [found, is_new] =
        middles_.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points_.size()));
    if (is_new) points_.push_back(unit(points_[a] + points_[b]));
    return found->second;
  }

  std::vector<Vec3> points_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;
};

/// An axis-aligned box in the frame of an oriented one.
struct LocalBox {
  Vec3 low;
  Vec3 high;
};

/// Adds a box with a color for each face.
void addBox(RenderSurface& surface, const Pose& object_from_box, const LocalBox& box,
            std::uint32_t color) {
  // Corner n is high along the axes whose bits are set.
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
      {{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3}, {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}}};
  // Opposite faces get the same light, since an object can lie on any of them.
  constexpr std::array<float, 3> kLights{0.86F, 1.0F, 0.72F};
  for (std::size_t face = 0; face < kFaces.size(); ++face) {
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    const std::uint32_t shade = dimmed(color, kLights[face / 2]);
    for (const std::uint32_t corner : kFaces[face]) {
      const Vec3 local{(corner & 1U) != 0 ? box.high.x : box.low.x,
                       (corner & 2U) != 0 ? box.high.y : box.low.y,
                       (corner & 4U) != 0 ? box.high.z : box.low.z};
      surface.vertices.push_back({.position = object_from_box * local, .color = shade});
    }
    for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) {
      surface.corners.push_back(first + corner);
    }
  }
}

}  // namespace

RenderSurface sphereSurface(float radius, std::uint32_t color) {
  constexpr int kSplits = 2;
  Icosphere sphere;
  for (int n = 0; n < kSplits; ++n) sphere.split();
  RenderSurface surface;
  surface.vertices.reserve(sphere.points().size());
  for (const Vec3& point : sphere.points()) {
    surface.vertices.push_back(
        {.position = point * radius, .color = dimmed(color, lightOn(point))});
  }
  surface.corners.reserve(3 * sphere.triangles().size());
  for (const auto& triangle : sphere.triangles()) {
    surface.corners.insert(surface.corners.end(), triangle.begin(), triangle.end());
  }
  return surface;
}

RenderSurface boxSurface(const OrientedBox& box, std::uint32_t color) {
  RenderSurface surface;
  const Vec3& h = box.half_extents;
  addBox(surface, box.pose, {h * -1.0F, h}, color);
  return surface;
}

RenderSurface boxFrameSurface(const OrientedBox& box, std::uint32_t color) {
  RenderSurface surface;
  const std::array<float, 3> half{box.half_extents.x, box.half_extents.y, box.half_extents.z};
  for (std::size_t along = 0; along < 3; ++along) {
    for (const unsigned side : {0U, 1U, 2U, 3U}) {
      std::array<float, 3> low{};
      std::array<float, 3> high{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool is_high = (side >> (axis == (along + 1) % 3 ? 0U : 1U) & 1U) != 0;
        const float middle = is_high ? half[axis] : -half[axis];
        low[axis] = (axis == along ? -half[axis] : middle) - kBeamHalfThickness;
        high[axis] = (axis == along ? half[axis] : middle) + kBeamHalfThickness;
      }
      addBox(surface, box.pose, {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}, color);
    }
  }
  return surface;
}

}  // namespace galactic::views
