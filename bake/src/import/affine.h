#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "galactic/bake/source_asset.h"

namespace galactic::bake {

/// The identity transform.
inline constexpr Affine kIdentityAffine{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/// Applies `b_from_c` first, then `a_from_b`.
[[nodiscard]] inline Affine compose(const Affine& a_from_b, const Affine& b_from_c) {
  Affine a_from_c{};
  for (std::size_t row = 0; row < 3; ++row) {
    const double* a = &a_from_b[4 * row];
    for (std::size_t column = 0; column < 4; ++column) {
      a_from_c[4 * row + column] =
          a[0] * b_from_c[column] + a[1] * b_from_c[4 + column] + a[2] * b_from_c[8 + column];
    }
    a_from_c[4 * row + 3] += a[3];
  }
  return a_from_c;
}

/// The point `p`, given in frame b, in frame a.
[[nodiscard]] inline std::array<double, 3> transformed(const Affine& a_from_b, const Vec3& p) {
  const std::array<double, 3> from{static_cast<double>(p.x), static_cast<double>(p.y),
                                   static_cast<double>(p.z)};
  std::array<double, 3> to{};
  for (std::size_t row = 0; row < 3; ++row) {
    const double* a = &a_from_b[4 * row];
    to[row] = a[0] * from[0] + a[1] * from[1] + a[2] * from[2] + a[3];
  }
  return to;
}

/// Volume scale of the linear part; negative if it mirrors.
[[nodiscard]] inline double determinant(const Affine& m) {
  return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
         m[2] * (m[4] * m[9] - m[5] * m[8]);
}

[[nodiscard]] inline bool isFinite(const Affine& m) {
  return std::all_of(m.begin(), m.end(), [](double v) { return std::isfinite(v); });
}

/// Whether the linear part flattens nothing. Compares the determinant with the lengths of the
/// columns, so that uniformly small or large scales pass.
[[nodiscard]] inline bool isInvertible(const Affine& m) {
  constexpr double kFlatness = 1e-9;
  double lengths = 1;
  for (std::size_t column = 0; column < 3; ++column) {
    lengths *= std::hypot(m[column], m[4 + column], m[8 + column]);
  }
  return std::isfinite(lengths) && std::abs(determinant(m)) > kFlatness * lengths;
}

}  // namespace galactic::bake
