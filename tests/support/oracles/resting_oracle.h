#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "galactic/pose.h"
#include "galactic/shapes.h"
#include "simulation/collision/resting_box.h"
#include "simulation/collision/sphere_batch.h"
#include "support/oracles/box_oracle.h"

namespace galactic::test {

using Point3 = std::array<double, 3>;

inline float uniformIn(std::mt19937& random, float lo, float hi) {
  const double share = uniform(random);
  return static_cast<float>(static_cast<double>(lo) +
                            share * (static_cast<double>(hi) - static_cast<double>(lo)));
}

inline Quat randomQuat(std::mt19937& random) {
  const auto [w, x, y, z] = randomRotation(random);
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z),
          static_cast<float>(w)};
}

/// A rotation about the vertical, as most objects rest.
inline Quat yaw(double angle) {
  return {0, static_cast<float>(std::sin(angle / 2)), 0, static_cast<float>(std::cos(angle / 2))};
}

inline Point3 toPoint3(const Vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// A box in double precision by its corner and edges: shares nothing with RestingBox.
class BoxSolid {
 public:
  BoxSolid(const OrientedBox& box, const Pose& world_from_object) {
    const Quat& q = world_from_object.rotation;
    const auto turned = [](const Quat& r, const Point3& p) {
      const double w = static_cast<double>(r.w);
      const Point3 u{static_cast<double>(r.x), static_cast<double>(r.y), static_cast<double>(r.z)};
      const double square = w * w + u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
      const double along = u[0] * p[0] + u[1] * p[1] + u[2] * p[2];
      const double keep = w * w - (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
      const Point3 across{u[1] * p[2] - u[2] * p[1], u[2] * p[0] - u[0] * p[2],
                          u[0] * p[1] - u[1] * p[0]};
      Point3 result{};
      for (std::size_t n = 0; n < 3; ++n) {
        result[n] = (keep * p[n] + 2 * along * u[n] + 2 * w * across[n]) / square;
      }
      return result;
    };
    center_ = turned(q, toPoint3(box.pose.translation));
    const Point3 origin = toPoint3(world_from_object.translation);
    half_ = toPoint3(box.half_extents);
    for (std::size_t n = 0; n < 3; ++n) {
      center_[n] += origin[n];
      Point3 unit{};
      unit[n] = 1;
      axes_[n] = turned(q, turned(box.pose.rotation, unit));
    }
  }

  [[nodiscard]] double distance(const Point3& point) const {
    const Point3 along = local(point);
    double sum = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      const double beyond = std::max(std::abs(along[n]) - half_[n], 0.0);
      sum += beyond * beyond;
    }
    return std::sqrt(sum);
  }

  [[nodiscard]] Point3 nearestTo(const Point3& point) const {
    Point3 share = local(point);
    for (std::size_t n = 0; n < 3; ++n) share[n] = std::clamp(share[n] / half_[n], -1.0, 1.0);
    return at(share);
  }

  /// A point of the box by its coordinates along the axes, each from -1 to 1.
  [[nodiscard]] Point3 at(const Point3& share) const {
    Point3 point = center_;
    for (std::size_t n = 0; n < 3; ++n) {
      for (std::size_t m = 0; m < 3; ++m) point[m] += share[n] * half_[n] * axes_[n][m];
    }
    return point;
  }

  void shiftUp(double by) { center_[1] += by; }

  [[nodiscard]] bool anyEdgeMeets(const BoxSolid& other) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (unsigned corner = 0; corner < 4; ++corner) {
        Point3 share{};
        share[(axis + 1) % 3] = (corner & 1U) != 0 ? 1 : -1;
        share[(axis + 2) % 3] = (corner & 2U) != 0 ? 1 : -1;
        share[axis] = -1;
        const Point3 from = at(share);
        share[axis] = 1;
        if (other.meetsSegment(from, at(share))) return true;
      }
    }
    return false;
  }

 private:
  /// Coordinates along the axes, from the center.
  [[nodiscard]] Point3 local(const Point3& point) const {
    Point3 result{};
    for (std::size_t n = 0; n < 3; ++n) {
      for (std::size_t m = 0; m < 3; ++m) result[n] += axes_[n][m] * (point[m] - center_[m]);
    }
    return result;
  }

  [[nodiscard]] bool meetsSegment(const Point3& from, const Point3& to) const {
    const Point3 start = local(from);
    const Point3 stop = local(to);
    double first = 0;
    double last = 1;
    for (std::size_t n = 0; n < 3; ++n) {
      const double step = stop[n] - start[n];
      if (step == 0 && std::abs(start[n]) >= half_[n]) return false;
      if (step == 0) continue;
      const double a = (-half_[n] - start[n]) / step;
      const double b = (half_[n] - start[n]) / step;
      first = std::max(first, std::min(a, b));
      last = std::min(last, std::max(a, b));
    }
    return first < last;
  }

  Point3 center_{};
  Point3 half_{};
  std::array<Point3, 3> axes_{};
};

/// Whether two boxes overlap: convex polyhedra do just when an edge of one meets the other. Shares
/// nothing with the separating-axis test.
inline bool boxesOverlap(const BoxSolid& a, const BoxSolid& b) {
  return a.anyEdgeMeets(b) || b.anyEdgeMeets(a);
}

/// One object in the world, for both sides of a comparison.
struct Body {
  OrientedBox box;
  Pose pose;

  [[nodiscard]] simulation::RestingBox resting() const { return simulation::restingBox(box, pose); }
  [[nodiscard]] BoxSolid solid() const { return {box, pose}; }
};

/// Where random objects are.
struct Room {
  Span x{-2.5F, 5.0F};
  Span z{-4.5F, 8.0F};
  /// Half extents of objects.
  float least = 0.025F;
  float most = 0.125F;
  /// How far beyond the room objects and spheres are found.
  float beyond = 0;
};

inline Body randomBody(const Room& room, std::mt19937& random) {
  Body body;
  const auto half = [&] { return uniformIn(random, room.least, room.most); };
  body.box.half_extents.x = half();
  body.box.half_extents.y = half();
  body.box.half_extents.z = half();
  body.box.pose = {{0.01F, 0.05F, -0.02F}, randomQuat(random)};
  Vec3& at = body.pose.translation;
  at.x = uniformIn(random, room.x.lo - room.beyond, room.x.hi + room.beyond);
  at.y = uniformIn(random, 0, 1.5F);
  at.z = uniformIn(random, room.z.lo - room.beyond, room.z.hi + room.beyond);
  body.pose.rotation = random() % 2 == 0 ? yaw(6.28 * uniform(random)) : randomQuat(random);
  return body;
}

/// Counts the answers of a property test: it tests something when both are common.
struct Tally {
  std::size_t yes = 0, no = 0;

  void add(bool answer) { (answer ? yes : no) += 1; }
  void expectBothSides() const {
    EXPECT_GE(10 * yes, yes + no) << yes << " of " << yes + no;
    EXPECT_LE(10 * yes, 9 * (yes + no)) << yes << " of " << yes + no;
  }
};

/// A batch that owns its spheres.
class OwnedBatch {
 public:
  /// Adds the spheres of one radius.
  OwnedBatch& add(std::uint32_t radius_index, float radius, const std::vector<Vec3>& centers) {
    const auto first = static_cast<std::uint32_t>(x_.size());
    ranges_.push_back({radius_index, radius, first, static_cast<std::uint32_t>(centers.size())});
    for (std::size_t n = 0; n < simulation::paddedToLanes(centers.size()); ++n) {
      const Vec3& center = centers[std::min(n, centers.size() - 1)];
      x_.push_back(center.x);
      y_.push_back(center.y);
      z_.push_back(center.z);
    }
    return *this;
  }

  [[nodiscard]] simulation::SphereBatch view() const {
    return {x_.data(), y_.data(), z_.data(), ranges_};
  }
  [[nodiscard]] Vec3 center(std::size_t n) const { return {x_[n], y_[n], z_[n]}; }

 private:
  std::vector<float> x_, y_, z_;
  std::vector<simulation::RadiusRange> ranges_;
};

}  // namespace galactic::test
