#include "ambient/ray_pattern.h"

#include <cmath>
#include <numbers>

namespace galactic::bake {
namespace {

/// The digits of `index` in `base`, mirrored at the radix point: 0 to 1.
double radicalInverse(unsigned index, unsigned base) {
  double value = 0;
  double digit = 1;
  for (; index > 0; index /= base) {
    digit /= base;
    value += digit * (index % base);
  }
  return value;
}

}  // namespace

std::vector<PatternRay> rayPattern(unsigned count) {
  std::vector<PatternRay> pattern;
  pattern.reserve(count);
  for (unsigned i = 0; i < count; ++i) {
    // The direction matters most, so it gets the most evenly distributed coordinates.
    const double height = (i + 0.5) / count;
    const double turn = radicalInverse(i, 2);
    PatternRay ray;
    ray.triangle = radicalInverse(i, 3);
    // The inverse of 3 x^2 - 2 x^3, the distribution function of a barycentric coordinate whose
    // density is proportional to it.
    ray.own = 0.5 - std::sin(std::asin(1 - 2 * radicalInverse(i, 5)) / 3);
    ray.next = (1 - ray.own) * radicalInverse(i, 7);
    const double radius = std::sqrt(height);
    const double angle = 2 * std::numbers::pi * turn;
    ray.direction = {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - height)};
    pattern.push_back(ray);
  }
  return pattern;
}

}  // namespace galactic::bake
