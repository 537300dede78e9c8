#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "galactic/bake/robot_import.h"
#include "import/affine.h"
#include "robot_description/description_process.h"
#include "robot_description/frames.h"
#include "robot_description/geometry_builder.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

using Point = std::array<double, 3>;
using Corners = std::array<Point, 3>;

/// A mesh whose volume is less than this share of the box around it says nothing about its mass: it
/// is open, or thin, or inside out in places.
constexpr double kLeastFilling = 1e-3;

/// For a solid of density 1: its volume, and the integrals of the coordinates and of their products
/// (xx, yy, zz, xy, xz, yz).
struct Integrals {
  double volume = 0;
  Point first{};
  std::array<double, 6> second{};
};

constexpr std::array<std::pair<std::size_t, std::size_t>, 6> kProducts{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

/// Sums over the tetrahedra from the origin to each triangle (Tonon 2004).
Integrals integralsOf(const std::vector<Corners>& triangles) {
  Integrals sum;
  for (const auto& [a, b, c] : triangles) {
    const double six_volumes = a[0] * (b[1] * c[2] - b[2] * c[1]) +
                               a[1] * (b[2] * c[0] - b[0] * c[2]) +
                               a[2] * (b[0] * c[1] - b[1] * c[0]);
    sum.volume += six_volumes / 6;
    for (std::size_t n = 0; n < 3; ++n) sum.first[n] += six_volumes / 24 * (a[n] + b[n] + c[n]);
    for (std::size_t n = 0; n < 6; ++n) {
      const auto [i, j] = kProducts[n];
      const double total_i = a[i] + b[i] + c[i];
      const double total_j = a[j] + b[j] + c[j];
      sum.second[n] +=
          six_volumes / 120 * (total_i * total_j + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
    }
  }
  return sum;
}

/// The integrals of the box around the triangles.
Integrals integralsOfBox(const std::vector<Corners>& triangles) {
  Point least = triangles.front()[0];
  Point most = least;
  for (const Corners& corners : triangles) {
    for (const Point& p : corners) {
      for (std::size_t n = 0; n < 3; ++n) {
        least[n] = std::min(least[n], p[n]);
        most[n] = std::max(most[n], p[n]);
      }
    }
  }
  Integrals box;
  Point middle{};
  box.volume = 1;
  for (std::size_t n = 0; n < 3; ++n) {
    middle[n] = (least[n] + most[n]) / 2;
    // Even a flat mesh has a mass.
    constexpr double kThinnest = 1e-4;
    box.volume *= std::max(most[n] - least[n], kThinnest);
  }
  for (std::size_t n = 0; n < 3; ++n) box.first[n] = box.volume * middle[n];
  for (std::size_t n = 0; n < 6; ++n) {
    const auto [i, j] = kProducts[n];
    const double spread = i == j ? (most[i] - least[i]) * (most[i] - least[i]) / 12 : 0;
    box.second[n] = box.volume * (middle[i] * middle[j] + spread);
  }
  return box;
}

LinkInertial inertialOf(const Integrals& solid, double mass) {
  const double density = mass / solid.volume;
  LinkInertial inertial;
  inertial.mass = mass;
  for (std::size_t n = 0; n < 3; ++n) inertial.center[n] = solid.first[n] / solid.volume;
  std::array<double, 6> about{};
  for (std::size_t n = 0; n < 6; ++n) {
    const auto [i, j] = kProducts[n];
    about[n] = density * solid.second[n] - mass * inertial.center[i] * inertial.center[j];
  }
  inertial.moments = {about[1] + about[2], about[0] + about[2], about[0] + about[1],
                      -about[3],           -about[4],           -about[5]};
  return inertial;
}

/// Combines the parts of one link.
LinkInertial sumOf(const std::string& link, const std::vector<LinkInertial>& parts) {
  LinkInertial sum{.link = link, .mass = 0, .center = {}, .moments = {}};
  for (const LinkInertial& part : parts) {
    sum.mass += part.mass;
    for (std::size_t n = 0; n < 3; ++n) sum.center[n] += part.mass * part.center[n];
  }
  if (sum.mass != 0) {
    for (double& coordinate : sum.center) coordinate /= sum.mass;
  }
  for (const LinkInertial& part : parts) {
    Point d{};
    for (std::size_t n = 0; n < 3; ++n) d[n] = part.center[n] - sum.center[n];
    const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    for (std::size_t n = 0; n < 6; ++n) {
      const auto [i, j] = kProducts[n];
      sum.moments[n] += part.moments[n] + part.mass * ((i == j ? square : 0) - d[i] * d[j]);
    }
  }
  return sum;
}

/// Computes the masses of the meshes of a robot's links; reads each file only once.
class MeshWeights {
 public:
  MeshWeights(const fs::path& path, const RobotDescription& model,
              const RobotImportOptions& options)
      : geometry_(path, model.meshes, options, robot_) {}

  /// None if the mesh is missing, which an import reports.
  Result<std::optional<LinkInertial>> of(const DescribedMass& mass) {
    DescribedLink link;
    link.name = "mass";
    link.collisions.push_back(mass.mesh);
    SourceLink read;
    RETURN_IF_ERROR(geometry_.addShapes(link, read));
    const std::vector<Corners> triangles = trianglesOf(read);
    if (triangles.empty()) return std::nullopt;
    Integrals solid = integralsOf(triangles);
    const Integrals box = integralsOfBox(triangles);
    if (!(solid.volume > kLeastFilling * box.volume)) solid = box;
    return inertialOf(solid, mass.has_mass ? mass.mass : mass.density * solid.volume);
  }

 private:
  /// In the link's frame, Z up, with the outside in front.
  [[nodiscard]] std::vector<Corners> trianglesOf(const SourceLink& link) const {
    std::vector<Corners> triangles;
    for (const LinkShape& shape : link.collisions) {
      const SourceAsset& asset = robot_.meshes[std::get<MeshShape>(shape.geometry).mesh];
      for (const SourceInstance& instance : asset.instances) {
        const Affine frame =
            compose(kZUpFromYUp, compose(shape.link_from_shape, instance.world_from_mesh));
        const SourceMesh& mesh = asset.meshes[instance.mesh];
        for (Triangle triangle : mesh.triangles) {
          if (determinant(frame) < 0) std::swap(triangle[1], triangle[2]);
          Corners& corners = triangles.emplace_back();
          for (std::size_t n = 0; n < 3; ++n) {
            corners[n] = transformed(frame, mesh.positions[triangle[n]]);
          }
        }
      }
    }
    return triangles;
  }

  SourceRobot robot_;
  GeometryBuilder geometry_;
};

}  // namespace

Result<std::vector<LinkInertial>> readInertials(const fs::path& path,
                                                const RobotImportOptions& options) {
  ASSIGN_OR_RETURN(const auto model, readDescription(path,
                                                     {.part = DescriptionPart::kMasses,
                                                      .allow_outside = options.allow_outside},
                                                     options.time_limit));
  RobotImportOptions lenient = options;
  lenient.allow_missing = true;
  lenient.up = UpAxis::kZ;
  MeshWeights weights(path, model, lenient);
  std::vector<LinkInertial> inertials;
  double total = 0;
  for (const DescribedLink& link : model.links) {
    std::vector<LinkInertial> parts = link.inertials;
    for (const DescribedMass& mass : link.masses) {
      ASSIGN_OR_RETURN(const auto weighed, weights.of(mass));
      if (weighed) parts.push_back(*weighed);
    }
    if (parts.empty()) continue;
    inertials.push_back(parts.size() == 1 ? parts.front() : sumOf(link.name, parts));
    inertials.back().link = link.name;
    total += inertials.back().mass;
  }
  if (model.total_mass > 0 && total > 0) {
    for (LinkInertial& inertial : inertials) {
      inertial.mass *= model.total_mass / total;
      for (double& moment : inertial.moments) moment *= model.total_mass / total;
    }
  }
  return inertials;
}

}  // namespace galactic::bake
