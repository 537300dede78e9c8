#include "fit/rotation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace galactic::bake::fit {
namespace {

/// A quaternion in double precision.
using Quaternion = std::array<double, 4>;  // x, y, z, w

Quat rounded(const Quaternion& q) {
  double length = 0;
  for (const double part : q) length += part * part;
  const double factor = (q[3] < 0 ? -1 : 1) / std::sqrt(length);
  const auto part = [&](std::size_t at) {
    // Avoid negative zero, so that equal rotations have equal bytes.
    return static_cast<float>(q[at] * factor) + 0.0F;
  };
  return {part(0), part(1), part(2), part(3)};
}

double trace(const Axes& axes) { return axes[0].x + axes[1].y + axes[2].z; }

}  // namespace

Axes nearestEquivalent(const Axes& axes) {
  // Of those equally near up to rounding, take the first in this order of permutations and signs.
  constexpr double kClearlyNearer = 1e-9;
  constexpr std::array<std::array<std::size_t, 3>, 6> kOrders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  Axes best = kIdentityAxes;
  double best_trace = -4;
  for (const auto& order : kOrders) {
    for (const double sign_x : {1.0, -1.0}) {
      for (const double sign_y : {1.0, -1.0}) {
        const Vec3d x = axes[order[0]] * sign_x;
        const Vec3d y = axes[order[1]] * sign_y;
        const Axes candidate{x, y, cross(x, y)};
        if (trace(candidate) <= best_trace + kClearlyNearer) continue;
        best = candidate;
        best_trace = trace(candidate);
      }
    }
  }
  return best;
}

Quat quaternionOf(const Axes& axes) {
  const auto& [x, y, z] = axes;
  // Shepperd's method (1978): divide by the greatest component.
  const std::array<double, 4> squares{1 + x.x - y.y - z.z, 1 - x.x + y.y - z.z, 1 - x.x - y.y + z.z,
                                      1 + x.x + y.y + z.z};
  const auto greatest = std::max_element(squares.begin(), squares.end()) - squares.begin();
  const double square = squares[static_cast<std::size_t>(greatest)];
  switch (greatest) {
    case 0:
      return rounded({square, x.y + y.x, z.x + x.z, y.z - z.y});
    case 1:
      return rounded({x.y + y.x, square, y.z + z.y, z.x - x.z});
    case 2:
      return rounded({z.x + x.z, y.z + z.y, square, x.y - y.x});
    default:
      return rounded({y.z - z.y, z.x - x.z, x.y - y.x, square});
  }
}

Axes axesOf(const Quat& rotation) {
  Quaternion q{static_cast<double>(rotation.x), static_cast<double>(rotation.y),
               static_cast<double>(rotation.z), static_cast<double>(rotation.w)};
  double length = 0;
  for (const double part : q) length += part * part;
  const double scale = 2 / length;
  const auto [x, y, z, w] = q;
  return {{{1 - scale * (y * y + z * z), scale * (x * y + w * z), scale * (x * z - w * y)},
           {scale * (x * y - w * z), 1 - scale * (x * x + z * z), scale * (y * z + w * x)},
           {scale * (x * z + w * y), scale * (y * z - w * x), 1 - scale * (x * x + y * y)}}};
}

Quat shortestArc(const Vec3d& from, const Vec3d& to) {
  constexpr double kOpposite = 1e-12;
  const double cosine = dot(from, to);
  if (cosine > -1 + kOpposite) {
    const Vec3d axis = cross(from, to);
    return rounded({axis.x, axis.y, axis.z, 1 + cosine});
  }
  const Vec3d other = std::abs(from.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1};
  const Vec3d axis = normalized(other - from * dot(other, from));
  return rounded({axis.x, axis.y, axis.z, 0});
}

}  // namespace galactic::bake::fit
