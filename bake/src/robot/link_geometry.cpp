#include <algorithm>
#include <cmath>
#include <numbers>

#include "import/affine.h"
#include "robot/robot_parts.h"

namespace galactic::bake {
namespace {

/// Collects a primitive's corners, placed in the link's frame.
class PrimitiveBuilder {
 public:
  PrimitiveBuilder(const Affine& link_from_shape, const std::array<float, 4>& color)
      : link_from_shape_(link_from_shape),
        mirrors_(determinant(link_from_shape) < 0),
        color_(surfaceColor(color)) {}

  std::uint32_t vertex(double x, double y, double z) {
    const Affine& m = link_from_shape_;
    const auto row = [&](std::size_t r) {
      return static_cast<float>(m[4 * r] * x + m[4 * r + 1] * y + m[4 * r + 2] * z + m[4 * r + 3]);
    };
    surface_.positions.push_back({row(0), row(1), row(2)});
    surface_.colors.push_back(color_);
    return static_cast<std::uint32_t>(surface_.positions.size() - 1);
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (mirrors_) std::swap(b, c);
    surface_.triangles.push_back({a, b, c});
  }

  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }

  Surface finish() { return std::move(surface_); }

 private:
  const Affine& link_from_shape_;
  bool mirrors_;
  std::uint32_t color_;
  Surface surface_;
};

/// Number of steps around a circle that keeps chords within `error` of it; a multiple of four, so
/// that the extremes along the axes are vertices.
std::uint32_t circleSteps(double radius, double error) {
  constexpr std::uint32_t kFewest = 16;
  constexpr std::uint32_t kMost = 256;
  const double ratio = std::clamp(1 - error / std::max(radius, 1e-9), -1.0, 1.0);
  const double half_step = std::acos(ratio);
  const double steps = half_step > 0 ? std::numbers::pi / half_step : kMost;
  const auto rounded =
      static_cast<std::uint32_t>(std::ceil(std::min<double>(steps, kMost) / 4)) * 4;
  return std::clamp(rounded, kFewest, kMost);
}

double angleOf(std::uint32_t step, std::uint32_t steps) {
  return 2 * std::numbers::pi * step / steps;
}

void addBox(const BoxShape& box, PrimitiveBuilder& builder) {
  std::array<std::uint32_t, 8> corner{};
  for (std::size_t n = 0; n < corner.size(); ++n) {
    corner[n] = builder.vertex((n & 1U) != 0 ? box.size[0] / 2 : -box.size[0] / 2,
                               (n & 2U) != 0 ? box.size[1] / 2 : -box.size[1] / 2,
                               (n & 4U) != 0 ? box.size[2] / 2 : -box.size[2] / 2);
  }
  builder.quad(corner[0], corner[4], corner[6], corner[2]);  // -x
  builder.quad(corner[1], corner[3], corner[7], corner[5]);  // +x
  builder.quad(corner[0], corner[1], corner[5], corner[4]);  // -y
  builder.quad(corner[2], corner[6], corner[7], corner[3]);  // +y
  builder.quad(corner[0], corner[2], corner[3], corner[1]);  // -z
  builder.quad(corner[4], corner[5], corner[7], corner[6]);  // +z
}

/// Adds a ring of vertices around Y.
std::vector<std::uint32_t> ring(double radius, double y, std::uint32_t steps,
                                PrimitiveBuilder& builder) {
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t n = 0; n < steps; ++n) {
    const double angle = angleOf(n, steps);
    vertices.push_back(builder.vertex(radius * std::cos(angle), y, radius * std::sin(angle)));
  }
  return vertices;
}

/// Adds the band between two rings, with `low` below `high`.
void addBand(const std::vector<std::uint32_t>& low, const std::vector<std::uint32_t>& high,
             PrimitiveBuilder& builder) {
  for (std::size_t n = 0; n < low.size(); ++n) {
    const std::size_t next = (n + 1) % low.size();
    builder.quad(low[n], high[n], high[next], low[next]);
  }
}

/// Adds triangles from a ring to a point; `above` means that the point lies above the ring.
void addCap(const std::vector<std::uint32_t>& rim, std::uint32_t point, bool above,
            PrimitiveBuilder& builder) {
  for (std::size_t n = 0; n < rim.size(); ++n) {
    const std::uint32_t next = rim[(n + 1) % rim.size()];
    if (above) {
      builder.triangle(rim[n], point, next);
    } else {
      builder.triangle(rim[n], next, point);
    }
  }
}

void addCylinder(const CylinderShape& cylinder, PrimitiveBuilder& builder) {
  const std::uint32_t steps = circleSteps(cylinder.radius, kTessellationError);
  const double top = cylinder.length / 2;
  const auto low = ring(cylinder.radius, -top, steps, builder);
  const auto high = ring(cylinder.radius, top, steps, builder);
  addBand(low, high, builder);
  addCap(low, builder.vertex(0, -top, 0), false, builder);
  addCap(high, builder.vertex(0, top, 0), true, builder);
}

void addSphere(const SphereShape& sphere, PrimitiveBuilder& builder) {
  // In the middle of a facet the errors of the chords around and along the height add up.
  const std::uint32_t steps = circleSteps(sphere.radius, kTessellationError / 2);
  const std::uint32_t bands = steps / 2;
  std::vector<std::uint32_t> below;
  for (std::uint32_t n = 1; n < bands; ++n) {
    const double angle = std::numbers::pi * n / bands;
    auto current =
        ring(sphere.radius * std::sin(angle), -sphere.radius * std::cos(angle), steps, builder);
    if (n == 1) {
      addCap(current, builder.vertex(0, -sphere.radius, 0), false, builder);
    } else {
      addBand(below, current, builder);
    }
    below = std::move(current);
  }
  addCap(below, builder.vertex(0, sphere.radius, 0), true, builder);
}

Surface surfaceOfShape(const SourceRobot& robot, const LinkShape& shape) {
  if (const auto* mesh = std::get_if<MeshShape>(&shape.geometry)) {
    return surfaceOf(robot.meshes[mesh->mesh], shape.link_from_shape,
                     shape.color ? &*shape.color : nullptr);
  }
  return surfaceOfPrimitive(shape);
}

}  // namespace

Surface surfaceOfPrimitive(const LinkShape& shape) {
  PrimitiveBuilder builder(shape.link_from_shape, shape.color.value_or(kPlainColor));
  if (const auto* box = std::get_if<BoxShape>(&shape.geometry)) addBox(*box, builder);
  if (const auto* rod = std::get_if<CylinderShape>(&shape.geometry)) addCylinder(*rod, builder);
  if (const auto* ball = std::get_if<SphereShape>(&shape.geometry)) addSphere(*ball, builder);
  return builder.finish();
}

Surface surfaceOfShapes(const SourceRobot& robot, const std::vector<LinkShape>& shapes) {
  Surface surface;
  for (const LinkShape& shape : shapes) append(surface, surfaceOfShape(robot, shape));
  return surface;
}

const std::vector<LinkShape>& drawnShapes(const SourceLink& link) {
  return link.visuals_are_lost ? link.collisions : link.visuals;
}

}  // namespace galactic::bake
