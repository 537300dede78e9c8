#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "galactic/scene.h"
#include "sphere_set/prepared_fit.h"

namespace galactic::bake::sphere_set {
namespace {

/// Meters. Smaller spheres would be smaller than the rounding of their centers.
constexpr float kLeastLength = 1e-4F;
constexpr float kGreatestLength = 10.0F;
/// How far the length of a normal may deviate from 1.
constexpr float kUnitTolerance = 1e-3F;
/// Meters.
constexpr float kGreatestExtent = 10.0F;

tl::unexpected<Error> refuse(const std::string& where, std::string message) {
  return fail(ErrorCode::kInvalidInput, where, std::move(message));
}

bool isLength(float value) { return value >= kLeastLength && value <= kGreatestLength; }

Result<void> checkRadii(const std::vector<float>& radii) {
  if (radii.empty() || radii.size() > kMostRadii) {
    return refuse("radii", fmt::format("{} radii were given; give 1 to {}, in meters, ascending",
                                       radii.size(), kMostRadii));
  }
  for (std::size_t at = 0; at < radii.size(); ++at) {
    const std::string where = fmt::format("radii[{}]", at);
    if (!isLength(radii[at])) {
      return refuse(where, fmt::format("the radius {} m is out of range; give {} to {} m",
                                       radii[at], kLeastLength, kGreatestLength));
    }
    if (at > 0 && radii[at] <= radii[at - 1]) {
      return refuse(where, fmt::format("{} m comes after {} m; list each radius once, ascending",
                                       radii[at], radii[at - 1]));
    }
  }
  return {};
}

}  // namespace

Result<void> checkOptions(const SphereSetOptions& options) {
  if (auto radii = checkRadii(options.radii); !radii) return radii;
  if (!isLength(options.eps)) {
    return refuse("eps", fmt::format("a tolerance of {} m was given; give {} to {} m", options.eps,
                                     kLeastLength, kGreatestLength));
  }
  if (!(options.tau >= 0 && options.tau <= kGreatestLength)) {
    return refuse("tau", fmt::format("a tolerance of {} m was given; give 0 to {} m", options.tau,
                                     kGreatestLength));
  }
  if (!options.support) return {};
  const Vec3& n = options.support->normal;
  const float norm = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
  if (!(std::fabs(norm - 1) <= kUnitTolerance)) {
    return refuse(
        "support.normal",
        fmt::format("({}, {}, {}) has the length {}; give a unit vector", n.x, n.y, n.z, norm));
  }
  if (!std::isfinite(options.support->offset)) {
    return refuse("support.offset",
                  fmt::format("the distance {} is not valid; give meters along the normal",
                              options.support->offset));
  }
  return {};
}

Result<void> checkMesh(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) {
    return refuse("mesh", "it has no triangles; give a surface to cover with spheres");
  }
  Bounds bounds{mesh.vertices[mesh.triangles[0][0]], mesh.vertices[mesh.triangles[0][0]]};
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      const Vec3& v = mesh.vertices[corner];
      if (!(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z))) {
        return refuse("mesh", fmt::format("vertex {} is not finite; repair the file", corner));
      }
      bounds.min = {std::min(bounds.min.x, v.x), std::min(bounds.min.y, v.y),
                    std::min(bounds.min.z, v.z)};
      bounds.max = {std::max(bounds.max.x, v.x), std::max(bounds.max.y, v.y),
                    std::max(bounds.max.z, v.z)};
    }
  }
  const Vec3 size{bounds.max.x - bounds.min.x, bounds.max.y - bounds.min.y,
                  bounds.max.z - bounds.min.z};
  if (!(std::max({size.x, size.y, size.z}) <= kGreatestExtent)) {
    return fail(
        ErrorCode::kUnsupported, "mesh",
        fmt::format("its extents are {:.3g} x {:.3g} x {:.3g} m, and sphere sets are made "
                    "for up to {} m; is its unit the centimeter or the millimeter? Give the "
                    "scale, or cut it",
                    size.x, size.y, size.z, kGreatestExtent));
  }
  return {};
}

}  // namespace galactic::bake::sphere_set
