#include "simulation/collision/resting_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace galactic::simulation {
namespace {

/// Added to a box's half height so that rounding cannot make it too small: more than ten times the
/// rounding error of distances as large as the box.
constexpr float kHeightSlack = 1e-5F;

/// 0 for negative numbers; NaN stays NaN, as with the second operand of maxps.
float positivePart(float value) { return 0 > value ? 0 : value; }

Quat normalized(const Quat& q) {
  const float length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {q.x / length, q.y / length, q.z / length, q.w / length};
}

float clampTo(float value, float half) { return std::clamp(value, -half, half); }

using Triple = std::array<double, 3>;

Triple triple(const Vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

double dotOf(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Triple crossOf(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A box in double precision.
struct Frame {
  explicit Frame(const RestingBox& box)
      : axes{triple(box.axis_x), triple(box.axis_y), triple(box.axis_z)},
        half(triple(box.half_extents)) {}

  /// Half the length of the box's shadow on `axis`, times the axis' length.
  [[nodiscard]] double reach(const Triple& axis) const {
    double sum = 0;
    for (std::size_t n = 0; n < 3; ++n) sum += half[n] * std::abs(dotOf(axes[n], axis));
    return sum;
  }

  std::array<Triple, 3> axes;
  Triple half;
};

/// The part of a line that satisfies all conditions so far.
struct Clip {
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool isEmpty() const { return !(lo < hi); }

  /// Keeps t with |at + slope * t| <= bound.
  void keepWithin(double at, double slope, double bound) {
    if (slope == 0) {
      if (!(std::abs(at) <= bound)) hi = -std::numeric_limits<double>::infinity();
      return;
    }
    const double a = (-bound - at) / slope;
    const double b = (bound - at) / slope;
    lo = std::max(lo, std::min(a, b));
    hi = std::min(hi, std::max(a, b));
  }

  /// Keeps t with a t^2 + 2 b t + c <= 0, a >= 0.
  void keepInside(double a, double b, double c) {
    if (a == 0) {
      if (!(c <= 0)) hi = -std::numeric_limits<double>::infinity();
      return;
    }
    const double rest = b * b - a * c;
    if (!(rest > 0)) {
      hi = -std::numeric_limits<double>::infinity();
      return;
    }
    const double root = std::sqrt(rest);
    lo = std::max(lo, (-b - root) / a);
    hi = std::min(hi, (-b + root) / a);
  }
};

/// A line in a box's frame: the points at + t * slope, t in meters, slope of unit length.
struct Line {
  Line(const Frame& frame, const Triple& from_center, const Triple& along) {
    for (std::size_t n = 0; n < 3; ++n) {
      at[n] = dotOf(frame.axes[n], from_center);
      slope[n] = dotOf(frame.axes[n], along);
    }
  }

  Triple at{};
  Triple slope{};
};

/// Computes the hull of a line's intersections with the parts of a rounded box.
class RoundedBox {
 public:
  RoundedBox(const Triple& half, double radius) : half_(half), radius_(radius) {}

  [[nodiscard]] Clip meet(const Line& line) {
    for (std::size_t axis = 0; axis < 3; ++axis) addSlab(line, axis);
    // Without rounding, the slabs are the whole box.
    if (radius_ == 0) return hull_;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (unsigned corner = 0; corner < 4; ++corner) addEdge(line, axis, corner);
    }
    for (unsigned corner = 0; corner < 8; ++corner) addCorner(line, corner);
    return hull_;
  }

 private:
  void add(const Clip& part) {
    if (part.isEmpty()) return;
    hull_.lo = std::min(hull_.lo, part.lo);
    hull_.hi = std::max(hull_.hi, part.hi);
  }

  /// The positive or the negative end of `axis`.
  [[nodiscard]] double end(std::size_t axis, bool positive) const {
    return positive ? half_[axis] : -half_[axis];
  }

  void addSlab(const Line& line, std::size_t longer) {
    Clip part;
    for (std::size_t n = 0; n < 3; ++n) {
      part.keepWithin(line.at[n], line.slope[n], half_[n] + (n == longer ? radius_ : 0));
    }
    add(part);
  }

  void addEdge(const Line& line, std::size_t axis, unsigned corner) {
    const std::size_t i = (axis + 1) % 3;
    const std::size_t j = (axis + 2) % 3;
    const double u = line.at[i] - end(i, (corner & 1U) != 0);
    const double v = line.at[j] - end(j, (corner & 2U) != 0);
    Clip part;
    part.keepWithin(line.at[axis], line.slope[axis], half_[axis]);
    part.keepInside(line.slope[i] * line.slope[i] + line.slope[j] * line.slope[j],
                    u * line.slope[i] + v * line.slope[j], u * u + v * v - radius_ * radius_);
    add(part);
  }

  void addCorner(const Line& line, unsigned corner) {
    Triple from{};
    for (std::size_t n = 0; n < 3; ++n) from[n] = line.at[n] - end(n, ((corner >> n) & 1U) != 0);
    Clip part;
    part.keepInside(dotOf(line.slope, line.slope), dotOf(from, line.slope),
                    dotOf(from, from) - radius_ * radius_);
    add(part);
  }

  Triple half_;
  double radius_;
  /// Empty: its ends are in reverse order.
  Clip hull_{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
};

}  // namespace

RestingBox restingBox(const OrientedBox& box, const Pose& world_from_object) noexcept {
  const Pose object{world_from_object.translation, normalized(world_from_object.rotation)};
  const Quat rotation = normalized(object.rotation * box.pose.rotation);
  RestingBox resting;
  resting.center = object * box.pose.translation;
  resting.axis_x = rotate(rotation, {1, 0, 0});
  resting.axis_y = rotate(rotation, {0, 1, 0});
  resting.axis_z = rotate(rotation, {0, 0, 1});
  resting.half_extents = box.half_extents;
  const Vec3& half = box.half_extents;
  resting.half_height = halfBounds(resting).y + kHeightSlack * (1 + half.x + half.y + half.z);
  return resting;
}

Vec3 halfBounds(const RestingBox& box) noexcept {
  const Vec3& half = box.half_extents;
  const auto reach = [&half](float x, float y, float z) {
    return std::fabs(x) * half.x + std::fabs(y) * half.y + std::fabs(z) * half.z;
  };
  return {reach(box.axis_x.x, box.axis_y.x, box.axis_z.x),
          reach(box.axis_x.y, box.axis_y.y, box.axis_z.y),
          reach(box.axis_x.z, box.axis_y.z, box.axis_z.z)};
}

Vec3 nearestPoint(const RestingBox& box, const Vec3& point) noexcept {
  const Vec3 offset = point - box.center;
  const Vec3& half = box.half_extents;
  const Vec3 local{dot(box.axis_x, offset), dot(box.axis_y, offset), dot(box.axis_z, offset)};
  const Vec3 inside{clampTo(local.x, half.x), clampTo(local.y, half.y), clampTo(local.z, half.z)};
  if (inside == local) return point;
  return box.center + box.axis_x * inside.x + box.axis_y * inside.y + box.axis_z * inside.z;
}

float squaredDistance(const RestingBox& box, const Vec3& point) noexcept {
  const Vec3 offset = point - box.center;
  const float x = positivePart(std::fabs(dot(box.axis_x, offset)) - box.half_extents.x);
  const float y = positivePart(std::fabs(dot(box.axis_y, offset)) - box.half_extents.y);
  const float z = positivePart(std::fabs(dot(box.axis_z, offset)) - box.half_extents.z);
  return x * x + y * y + z * z;
}

bool overlaps(const RestingBox& box, const Vec3& center, float radius) noexcept {
  return squaredDistance(box, center) < radius * radius;
}

std::optional<Span> overlapHeights(const RestingBox& box, float x, float z, float radius) noexcept {
  const Frame frame(box);
  const Triple offset{static_cast<double>(x) - static_cast<double>(box.center.x), 0,
                      static_cast<double>(z) - static_cast<double>(box.center.z)};
  const Line line(frame, offset, {0, 1, 0});
  const Clip met = RoundedBox(frame.half, static_cast<double>(radius)).meet(line);
  if (met.isEmpty()) return std::nullopt;
  const auto height = static_cast<double>(box.center.y);
  return Span{static_cast<float>(height + met.lo), static_cast<float>(height + met.hi)};
}

std::optional<double> wayToOverlap(const RestingBox& box, const Vec3& from,
                                   const std::array<double, 3>& along, float radius) noexcept {
  const Frame frame(box);
  Triple offset = triple(from);
  const Triple center = triple(box.center);
  for (std::size_t n = 0; n < 3; ++n) offset[n] -= center[n];
  const Line line(frame, offset, along);
  const Clip met = RoundedBox(frame.half, static_cast<double>(radius)).meet(line);
  if (met.isEmpty() || !(met.hi > 0)) return std::nullopt;
  return std::max(met.lo, 0.0);
}

std::optional<Span> overlapShifts(const RestingBox& moving, const RestingBox& fixed) noexcept {
  // The cross product of two nearly parallel axes adds nothing to the axes themselves.
  constexpr double kNearlyParallel = 1e-10;
  const Frame a(moving);
  const Frame b(fixed);
  const Triple from = triple(fixed.center);
  Triple offset = triple(moving.center);
  for (std::size_t n = 0; n < 3; ++n) offset[n] -= from[n];
  Clip shifts;
  const auto keep_overlapping = [&](const Triple& axis) {
    shifts.keepWithin(dotOf(axis, offset), axis[1], a.reach(axis) + b.reach(axis));
  };
  for (std::size_t n = 0; n < 3; ++n) {
    keep_overlapping(a.axes[n]);
    keep_overlapping(b.axes[n]);
    for (std::size_t m = 0; m < 3; ++m) {
      const Triple axis = crossOf(a.axes[n], b.axes[m]);
      if (dotOf(axis, axis) > kNearlyParallel) keep_overlapping(axis);
    }
  }
  if (shifts.isEmpty()) return std::nullopt;
  return Span{static_cast<float>(shifts.lo), static_cast<float>(shifts.hi)};
}

}  // namespace galactic::simulation
