#include "episodes/import/object_frame.h"

#include <cmath>
#include <numbers>

namespace galactic::bake {

Rotation fileFromPack(UpAxis up) {
  constexpr double kHalf = std::numbers::sqrt2 / 2;
  switch (up) {
    case UpAxis::kX:
      return {kHalf, 0, 0, -kHalf};
    case UpAxis::kY:
      return {1, 0, 0, 0};
    case UpAxis::kZ:
      return {kHalf, kHalf, 0, 0};
    case UpAxis::kMinusX:
      return {kHalf, 0, 0, kHalf};
    case UpAxis::kMinusY:
      return {0, 1, 0, 0};
    case UpAxis::kMinusZ:
      return {kHalf, -kHalf, 0, 0};
  }
  return {1, 0, 0, 0};
}

Rotation product(const Rotation& a, const Rotation& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

double lengthOf(const Rotation& r) {
  return std::hypot(std::hypot(r[0], r[1]), std::hypot(r[2], r[3]));
}

Rotation ofUnitLength(const Rotation& rotation) {
  constexpr double kRounding = 1e-6;
  const double length = lengthOf(rotation);
  if (std::abs(length - 1) <= kRounding) return rotation;
  return {rotation[0] / length, rotation[1] / length, rotation[2] / length, rotation[3] / length};
}

Quat narrow(const Rotation& rotation) {
  return {static_cast<float>(rotation[1]), static_cast<float>(rotation[2]),
          static_cast<float>(rotation[3]), static_cast<float>(rotation[0])};
}

Pose narrow(const std::array<double, 3>& point, const Rotation& rotation) {
  return {
      {static_cast<float>(point[0]), static_cast<float>(point[1]), static_cast<float>(point[2])},
      narrow(rotation)};
}

}  // namespace galactic::bake
