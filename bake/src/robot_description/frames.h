#pragma once
#include <array>

#include "galactic/bake/source_asset.h"
#include "import/affine.h"

namespace galactic::bake {

/// Takes (x, y, z) to (x, z, -y): from the URDF's frame to the runtime's, Y up and X forward.
inline constexpr Affine kYUpFromZUp{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0};
/// The inverse of kYUpFromZUp.
inline constexpr Affine kZUpFromYUp{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0};

/// Adding zero turns -0 into +0, so that equal transforms have equal bytes.
[[nodiscard]] inline Affine withoutNegativeZeros(Affine affine) {
  for (double& value : affine) value += 0.0;
  return affine;
}

/// `a * m * b`.
[[nodiscard]] inline Affine conjugate(const Affine& a, const Affine& m, const Affine& b) {
  return withoutNegativeZeros(compose(compose(a, m), b));
}

[[nodiscard]] inline std::array<double, 3> transformed(const Affine& m,
                                                       const std::array<double, 3>& p) {
  std::array<double, 3> to{};
  for (std::size_t row = 0; row < 3; ++row) {
    const double* r = &m[4 * row];
    to[row] = r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3];
    to[row] += 0.0;
  }
  return to;
}

}  // namespace galactic::bake
