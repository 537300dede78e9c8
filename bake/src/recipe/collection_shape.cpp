#include "recipe/collection_shape.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "import/affine.h"
#include "import/axis_convention.h"
#include "sphere_set/authored_spheres.h"

namespace galactic::bake {
namespace {

using Point = std::array<double, 3>;

/// Exact, because the turn only permutes axes and changes signs.
Point turned(const Affine& turn, const Point& point) {
  Point result{};
  for (std::size_t row = 0; row < 3; ++row) {
    const double* m = &turn[4 * row];
    result[row] = m[0] * point[0] + m[1] * point[1] + m[2] * point[2];
  }
  return result;
}

Vec3 narrow(const Point& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

}  // namespace

Result<AuthoredShape> shapeFromCollection(const CollectionObject& object, UpAxis up,
                                          const std::vector<float>& radii) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (object.box_max[axis] > object.box_min[axis]) continue;
    return fail(ErrorCode::kInvalidInput, fmt::format("object '{}'", object.name),
                "has a box without volume; give it extents above 0");
  }
  const Affine pack_from_file = worldFromFile({.up = {up, ""}, .meters = {1, ""}});
  const Point a = turned(pack_from_file, object.box_min);
  const Point b = turned(pack_from_file, object.box_max);
  AuthoredShape shape;
  shape.box = {narrow({std::min(a[0], b[0]), std::min(a[1], b[1]), std::min(a[2], b[2])}),
               narrow({std::max(a[0], b[0]), std::max(a[1], b[1]), std::max(a[2], b[2])})};
  std::vector<HandSphere> spheres = object.technique == SphereTechnique::kListed
                                        ? object.spheres
                                        : publishedSpheres(object, radii);
  for (HandSphere& sphere : spheres) sphere.center = turned(pack_from_file, sphere.center);
  SnappedSpheres snapped = snapRadii(spheres, radii);
  if (snapped.largest_change > kRadiusChangeWorthMentioning) {
    return fail(ErrorCode::kInvalidInput, fmt::format("object '{}'", object.name),
                fmt::format("lists spheres whose radii are up to {:.4g} m off the working set {}; "
                            "give its radii with `radii`",
                            snapped.largest_change, fmt::join(radii, ",")));
  }
  shape.spheres = std::move(snapped.spheres);
  return shape;
}

}  // namespace galactic::bake
