#include "import/axis_convention.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "import/affine.h"

namespace galactic::bake {
namespace {

constexpr std::array<std::string_view, 6> kAxisNames{"X", "Y", "Z", "-X", "-Y", "-Z"};

Affine rotationFor(UpAxis up) {
  switch (up) {
    case UpAxis::kX:
      return {0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0};
    case UpAxis::kY:
      return kIdentityAffine;
    case UpAxis::kZ:
      return {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0};
    case UpAxis::kMinusX:
      return {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0};
    case UpAxis::kMinusY:
      return {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0};
    case UpAxis::kMinusZ:
      return {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0};
  }
  return kIdentityAffine;
}

}  // namespace

AxisConvention withOverrides(AxisConvention stated, const MeshImportOptions& options) {
  if (options.up) stated.up = {*options.up, kByUp};
  if (options.scale) stated.meters = {*options.scale, kByScale};
  return stated;
}

Affine worldFromFile(const AxisConvention& convention) {
  Affine matrix = rotationFor(convention.up.value);
  for (double& value : matrix) value *= convention.meters.value;
  return matrix;
}

bool isUnitStated(const AxisConvention& convention) {
  return convention.meters.by == kByFile || convention.meters.by == kByScale;
}

std::string describe(const AxisConvention& convention) {
  return fmt::format("{} up ({}), {} m per unit ({})",
                     kAxisNames[static_cast<std::size_t>(convention.up.value)], convention.up.by,
                     convention.meters.value, convention.meters.by);
}

double shortestDecimal(float value) {
  std::array<char, 64> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  double decimal = static_cast<double>(value);
  std::from_chars(text.data(), end, decimal);
  return decimal;
}

std::optional<AxisConvention> conventionOf(const Affine& world_from_file,
                                           std::string_view stated_by) {
  const double scale = std::cbrt(determinant(world_from_file));
  if (!std::isfinite(scale) || scale <= 0) return std::nullopt;
  constexpr double kFloatRounding = 1e-6;
  for (const UpAxis up : {UpAxis::kY, UpAxis::kZ, UpAxis::kX}) {
    const Affine rotation = rotationFor(up);
    double deviation = 0;
    for (std::size_t i = 0; i < rotation.size(); ++i) {
      deviation = std::max(deviation, std::abs(world_from_file[i] - scale * rotation[i]));
    }
    if (deviation > kFloatRounding * scale) continue;
    const double meters = shortestDecimal(static_cast<float>(scale));
    return AxisConvention{.up = {up, stated_by}, .meters = {meters, stated_by}};
  }
  return std::nullopt;
}

}  // namespace galactic::bake
