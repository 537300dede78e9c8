#pragma once
#include <fmt/format.h>

#include <string>

#include "galactic/bake/triangle_mesh.h"
#include "support/option_table.h"

namespace galactic::dynamics {

// What bodies may have. The engine computes with floats: numbers that are far from all that robots
// meet are lost in them, or make others be lost.

/// Kilograms.
inline constexpr Within<double> kMasses{1e-6, 1e6};
/// Of a surface; that of a pair is the product.
inline constexpr Within<double> kFrictions{0, 10};
/// Of a center of mass along an axis, meters.
inline constexpr Within<double> kCenters{-bake::kMaxCoordinate, bake::kMaxCoordinate};
/// Principal moments of inertia, kg m^2: from those of a grain of the least mass to those of the
/// greatest mass as far out as shapes reach.
inline constexpr Within<double> kMoments{1e-15, 1e12};

/// False of what is no number.
[[nodiscard]] constexpr bool contains(const Within<double>& range, double value) {
  return range.least <= value && value <= range.most;
}

/// "expected 1e-06 to 1e+06".
[[nodiscard]] inline std::string expectedText(const Within<double>& range) {
  return fmt::format("expected {:g} to {:g}", range.least, range.most);
}

}  // namespace galactic::dynamics
