#pragma once
#include <fmt/format.h>

#include <string>

#include "galactic/bake/triangle_mesh.h"
#include "support/option_table.h"

namespace galactic::dynamics {

// Ranges of the properties of bodies. The engine computes in floats: numbers far from those of real
// robots and objects would vanish in rounding, or make others vanish.

/// Kilograms.
inline constexpr Within<double> kMasses{1e-6, 1e6};
/// Friction of a surface; the friction of a pair is the product.
inline constexpr Within<double> kFrictions{0, 10};
/// Coordinates of a center of mass, meters.
inline constexpr Within<double> kCenters{-bake::kMaxCoordinate, bake::kMaxCoordinate};
/// Principal moments of inertia, kg m^2: from those of a grain with the smallest mass to those of
/// the largest mass at the largest distance of a shape.
inline constexpr Within<double> kMoments{1e-15, 1e12};

/// Whether a value is within a range; false for NaN.
[[nodiscard]] constexpr bool contains(const Within<double>& range, double value) {
  return range.least <= value && value <= range.most;
}

/// "expected 1e-06 to 1e+06".
[[nodiscard]] inline std::string expectedText(const Within<double>& range) {
  return fmt::format("expected {:g} to {:g}", range.least, range.most);
}

}  // namespace galactic::dynamics
