#include "dynamics/sources/hull_points.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <variant>

#include "galactic/bake/triangle_mesh.h"

namespace galactic::dynamics {
namespace {

using bake::Affine;

/// Corners of the polygons that approximate circles: the hull is 0.5 % thinner than the circle.
constexpr int kRing = 32;
constexpr int kRingsOfSphere = 16;

Vec3 transformed(const Affine& m, double x, double y, double z) {
  const auto row = [&](std::size_t r) {
    return static_cast<float>(m[4 * r] * x + m[4 * r + 1] * y + m[4 * r + 2] * z + m[4 * r + 3]);
  };
  return {row(0), row(1), row(2)};
}

/// The corners in the order of the vertices, not of the triangles.
HullPoints cornersOf(const bake::SourceAsset& asset, const bake::SourceInstance& instance) {
  const bake::SourceMesh& mesh = asset.meshes[instance.mesh];
  std::vector<bool> is_corner(mesh.positions.size(), false);
  for (const bake::Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) is_corner[corner] = true;
  }
  HullPoints points;
  for (std::size_t n = 0; n < is_corner.size(); ++n) {
    if (!is_corner[n]) continue;
    const Vec3& p = mesh.positions[n];
    points.push_back(transformed(instance.world_from_mesh, static_cast<double>(p.x),
                                 static_cast<double>(p.y), static_cast<double>(p.z)));
  }
  return points;
}

/// Appends the points of one shape, as one hull or several.
class HullMaker {
 public:
  HullMaker(const bake::SourceRobot& source, const Affine& link_from_shape,
            std::vector<HullPoints>& hulls)
      : source_(source), link_from_shape_(link_from_shape), hulls_(hulls) {}

  void operator()(const bake::BoxShape& box) {
    HullPoints& hull = hulls_.emplace_back();
    for (int corner = 0; corner < 8; ++corner) {
      const auto side = [&](int axis) {
        const double half = box.size[static_cast<std::size_t>(axis)] / 2;
        return (corner >> axis & 1) != 0 ? half : -half;
      };
      add(hull, side(0), side(1), side(2));
    }
  }
  void operator()(const bake::CylinderShape& cylinder) {
    HullPoints& hull = hulls_.emplace_back();
    for (const double y : {-cylinder.length / 2, cylinder.length / 2}) {
      addRing(hull, cylinder.radius, y);
    }
  }
  void operator()(const bake::SphereShape& sphere) {
    HullPoints& hull = hulls_.emplace_back();
    for (int ring = 0; ring <= kRingsOfSphere; ++ring) {
      const double angle = std::numbers::pi * ring / kRingsOfSphere;
      addRing(hull, sphere.radius * std::sin(angle), sphere.radius * std::cos(angle));
    }
  }
  void operator()(const bake::MeshShape& mesh) {
    const bake::SourceAsset& asset = source_.meshes[mesh.mesh];
    for (const bake::SourceInstance& instance : asset.instances) {
      const HullPoints corners = cornersOf(asset, instance);
      if (corners.empty()) continue;
      HullPoints& hull = hulls_.emplace_back();
      for (const Vec3& p : corners) {
        add(hull, static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
      }
    }
  }

 private:
  void add(HullPoints& hull, double x, double y, double z) {
    hull.push_back(transformed(link_from_shape_, x, y, z));
  }
  void addRing(HullPoints& hull, double radius, double y) {
    for (int n = 0; n < kRing; ++n) {
      const double angle = 2 * std::numbers::pi * n / kRing;
      add(hull, radius * std::cos(angle), y, radius * std::sin(angle));
    }
  }

  const bake::SourceRobot& source_;
  const Affine& link_from_shape_;
  std::vector<HullPoints>& hulls_;
};

}  // namespace

HullPoints cornersOf(const bake::SourceAsset& asset) {
  HullPoints points;
  for (const bake::SourceInstance& instance : asset.instances) {
    const HullPoints part = cornersOf(asset, instance);
    points.insert(points.end(), part.begin(), part.end());
  }
  return points;
}

std::vector<HullPoints> piecesOf(const bake::SourceAsset& asset, bool is_joined) {
  constexpr std::size_t kLeastCorners = 4;
  std::vector<HullPoints> pieces;
  if (is_joined) {
    pieces.push_back(cornersOf(asset));
  } else {
    for (const bake::SourceInstance& one : asset.instances) pieces.push_back(cornersOf(asset, one));
  }
  std::erase_if(pieces, [](const HullPoints& piece) { return piece.size() < kLeastCorners; });
  return pieces;
}

std::vector<HullPoints> hullPointsOf(const bake::SourceRobot& source,
                                     const bake::SourceLink& link) {
  std::vector<HullPoints> hulls;
  for (const bake::LinkShape& shape : link.collisions.empty() ? link.visuals : link.collisions) {
    std::visit(HullMaker(source, shape.link_from_shape, hulls), shape.geometry);
  }
  return hulls;
}

Result<void> checkExtents(std::span<const HullPoints> hulls, const std::string& where) {
  for (const HullPoints& points : hulls) {
    for (const Vec3& p : points) {
      for (const float coordinate : {p.x, p.y, p.z}) {
        const double away = std::abs(static_cast<double>(coordinate));
        if (away <= bake::kMaxCoordinate) continue;
        return fail(ErrorCode::kInvalidInput, where,
                    fmt::format("it reaches {:.4g} m from the origin, but only {} m are possible; "
                                "is its unit the meter?",
                                away, bake::kMaxCoordinate));
      }
    }
  }
  return {};
}

}  // namespace galactic::dynamics
