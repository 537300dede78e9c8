#include "robot_description/mjcf/geoms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "import/affine.h"

namespace galactic::bake {
namespace {

constexpr double kDensityOfWater = 1000;
/// The viewer hides higher groups by default.
constexpr double kLastGroupShown = 2;

enum class GeomType { kSphere, kCapsule, kEllipsoid, kCylinder, kBox, kMesh, kPlane, kField, kSdf };
constexpr std::array<std::string_view, 9> kTypes{
    "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "plane", "hfield", "sdf"};

/// Half extents along the axes of a primitive; for a capsule, radius and half length of its
/// cylinder.
struct Primitive {
  GeomType type = GeomType::kSphere;
  std::array<double, 3> half{};
  Affine body_from_shape{};
};

std::size_t sizesOf(GeomType type) {
  if (type == GeomType::kSphere) return 1;
  return type == GeomType::kCapsule || type == GeomType::kCylinder ? 2 : 3;
}

/// Sets size and pose of a primitive that lies between two points. As in MuJoCo, Z points from the
/// second to the first.
void stretch(const std::array<double, 6>& ends, const MjcfAttributes& geom, Primitive& primitive) {
  std::array<double, 3> middle{};
  std::array<double, 3> way{};
  for (std::size_t n = 0; n < 3; ++n) {
    middle[n] = (ends[n] + ends[n + 3]) / 2;
    way[n] = ends[n] - ends[n + 3];
  }
  const double half = std::hypot(way[0], way[1], way[2]) / 2;
  if (!(half > 0)) return geom.error("fromto", "two points that differ");
  const bool is_round =
      primitive.type == GeomType::kCapsule || primitive.type == GeomType::kCylinder;
  if (is_round) {
    primitive.half[1] = half;
  } else {
    primitive.half[1] = primitive.half[0];
    primitive.half[2] = half;
  }
  primitive.body_from_shape =
      compose(primitive.body_from_shape, compose(translationOf(middle), rotationOfZ(way)));
}

std::optional<Primitive> readPrimitive(const MjcfAttributes& geom, GeomType type,
                                       const Affine& body_from_frame,
                                       const MjcfSettings& settings) {
  Primitive primitive{.type = type, .half = {}, .body_from_shape = body_from_frame};
  const bool can_be_stretched = type != GeomType::kSphere;
  const auto ends = can_be_stretched ? geom.vector<6>("fromto") : std::nullopt;
  const std::size_t wanted = ends ? 1 : sizesOf(type);
  const auto sizes = geom.numbers("size", 1, 3);
  const bool enough = sizes && sizes->size() >= wanted &&
                      std::all_of(sizes->begin(), sizes->begin() + static_cast<int>(wanted),
                                  [](double size) { return size > 0; });
  if (!enough) {
    if (!geom.findings().firstError()) {
      geom.error("size",
                 fmt::format("{} positive number{} for a {}", wanted, wanted == 1 ? "" : "s",
                             kTypes[static_cast<std::size_t>(type)]));
    }
    return std::nullopt;
  }
  std::copy_n(sizes->begin(), wanted, primitive.half.begin());
  if (ends) {
    stretch(*ends, geom, primitive);
  } else {
    primitive.body_from_shape = compose(body_from_frame, poseOf(geom, settings));
  }
  return primitive;
}

double volumeOf(const Primitive& primitive) {
  constexpr double kPi = std::numbers::pi;
  const auto& [a, b, c] = primitive.half;
  switch (primitive.type) {
    case GeomType::kSphere:
      return 4 * kPi / 3 * a * a * a;
    case GeomType::kCapsule:
      return kPi * a * a * (2 * b + 4 * a / 3);
    case GeomType::kCylinder:
      return 2 * kPi * a * a * b;
    case GeomType::kEllipsoid:
      return 4 * kPi / 3 * a * b * c;
    default:
      return 8 * a * b * c;
  }
}

/// Moments about its center, along its axes.
std::array<double, 3> momentsOf(const Primitive& primitive, double mass) {
  const auto& [a, b, c] = primitive.half;
  const auto of_squares = [a = a, b = b, c = c](double share) {
    return std::array<double, 3>{share * (b * b + c * c), share * (a * a + c * c),
                                 share * (a * a + b * b)};
  };
  switch (primitive.type) {
    case GeomType::kSphere: {
      const double all = 0.4 * mass * a * a;
      return {all, all, all};
    }
    case GeomType::kCapsule: {
      const double ends = mass * (4 * a / 3) / (2 * b + 4 * a / 3);
      const double rod = mass - ends;
      const double across =
          rod * (3 * a * a + 4 * b * b) / 12 + ends * (0.4 * a * a + b * b + 0.75 * a * b);
      return {across, across, rod * a * a / 2 + 0.4 * ends * a * a};
    }
    case GeomType::kCylinder: {
      const double across = mass * (3 * a * a + 4 * b * b) / 12;
      return {across, across, mass * a * a / 2};
    }
    case GeomType::kEllipsoid:
      return of_squares(mass / 5);
    default:
      return of_squares(mass / 3);
  }
}

DescribedShape placed(DescribedGeometry geometry, const std::array<double, 3>& size,
                      const Affine& frame) {
  DescribedShape shape;
  shape.geometry = geometry;
  shape.size = size;
  shape.link_from_shape = frame;
  return shape;
}

std::vector<DescribedShape> shapesOf(const Primitive& primitive) {
  const auto& [a, b, c] = primitive.half;
  const Affine& frame = primitive.body_from_shape;
  switch (primitive.type) {
    case GeomType::kSphere:
      return {placed(DescribedGeometry::kSphere, {a, 0, 0}, frame)};
    case GeomType::kCylinder:
      return {placed(DescribedGeometry::kCylinder, {a, 2 * b, 0}, frame)};
    case GeomType::kEllipsoid:
      return {placed(DescribedGeometry::kEllipsoid, {a, b, c}, frame)};
    case GeomType::kCapsule:
      return {
          placed(DescribedGeometry::kCylinder, {a, 2 * b, 0}, frame),
          placed(DescribedGeometry::kSphere, {a, 0, 0}, compose(frame, translationOf({0, 0, -b}))),
          placed(DescribedGeometry::kSphere, {a, 0, 0}, compose(frame, translationOf({0, 0, b})))};
    default:
      return {placed(DescribedGeometry::kBox, {2 * a, 2 * b, 2 * c}, frame)};
  }
}

/// The mass that the text states, if any; refuses negative ones.
std::optional<double> massOf(const MjcfAttributes& geom) {
  if (!geom.has("mass")) return std::nullopt;
  const double mass = geom.number("mass", 0);
  if (mass < 0) geom.error("mass", "kilograms, not below 0");
  return mass;
}

void weigh(const MjcfAttributes& geom, const Primitive* primitive, MjcfGeom& read) {
  const std::optional<double> stated = massOf(geom);
  const double density = geom.number("density", kDensityOfWater);
  if (density < 0) geom.error("density", "kg/m^3, not below 0");
  if (stated ? *stated == 0 : density == 0) return;
  if (primitive == nullptr) {
    read.mass = DescribedMass{.mesh = read.shapes.front(),
                              .has_mass = stated.has_value(),
                              .mass = stated.value_or(0),
                              .density = density};
    return;
  }
  const double mass = stated.value_or(density * volumeOf(*primitive));
  const auto [x, y, z] = momentsOf(*primitive, mass);
  const Affine& frame = primitive->body_from_shape;
  read.inertial = LinkInertial{.link = {},
                               .mass = mass,
                               .center = {frame[3], frame[7], frame[11]},
                               .moments = momentsAlong(frame, {x, y, z, 0, 0, 0})};
}

/// The shape of a mesh; none if there is no such asset.
std::optional<DescribedShape> readMeshGeom(const MjcfAttributes& geom, GeomType type,
                                           const Affine& body_from_frame, const MjcfAssets& assets,
                                           const MjcfSettings& settings) {
  const MjcfMesh* mesh = assets.meshOf(geom);
  if (mesh == nullptr) return std::nullopt;
  if (type != GeomType::kMesh) {
    geom.findings().warn(
        fmt::format("a {} is to be fitted to the mesh '{}'; the mesh itself counts",
                    kTypes[static_cast<std::size_t>(type)], geom.text("mesh")));
  }
  DescribedShape shape = mesh->shape;
  shape.link_from_shape =
      compose(compose(body_from_frame, poseOf(geom, settings)), shape.link_from_shape);
  return shape;
}

}  // namespace

std::array<double, 6> momentsAlong(const Affine& turned, const std::array<double, 6>& principal) {
  const std::array<std::array<double, 3>, 3> m{{{principal[0], principal[3], principal[4]},
                                                {principal[3], principal[1], principal[5]},
                                                {principal[4], principal[5], principal[2]}}};
  const auto along = [&](std::size_t i, std::size_t j) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t l = 0; l < 3; ++l) sum += turned[4 * i + k] * m[k][l] * turned[4 * j + l];
    }
    return sum;
  };
  return {along(0, 0), along(1, 1), along(2, 2), along(0, 1), along(0, 2), along(1, 2)};
}

std::optional<MjcfGeom> readGeom(const MjcfAttributes& geom, const Affine& body_from_frame,
                                 const MjcfAssets& assets, const MjcfSettings& settings) {
  const auto type = static_cast<GeomType>(geom.choice("type", kTypes, 0));
  if (type == GeomType::kPlane || type == GeomType::kField || type == GeomType::kSdf) {
    geom.findings().warn(fmt::format("a <geom> of type {} is left out: no robot consists of it",
                                     kTypes[static_cast<std::size_t>(type)]));
    return std::nullopt;
  }
  MjcfGeom read;
  if (type == GeomType::kMesh || geom.has("mesh")) {
    const auto shape = readMeshGeom(geom, type, body_from_frame, assets, settings);
    if (!shape) return std::nullopt;
    read.shapes.push_back(*shape);
    weigh(geom, nullptr, read);
  } else {
    const auto primitive = readPrimitive(geom, type, body_from_frame, settings);
    if (!primitive) return std::nullopt;
    read.shapes = shapesOf(*primitive);
    weigh(geom, &*primitive, read);
  }
  for (DescribedShape& shape : read.shapes) assets.paint(geom, shape);
  const DescribedShape& first = read.shapes.front();
  read.is_invisible = first.has_color && first.color[3] == 0;
  read.collides = geom.number("contype", 1) != 0 || geom.number("conaffinity", 1) != 0;
  const double group = geom.number("group", 0);
  read.is_shown = group <= kLastGroupShown;
  if (group < settings.massive_groups[0] || group > settings.massive_groups[1]) {
    read.inertial.reset();
    read.mass.reset();
  }
  return read;
}

}  // namespace galactic::bake
