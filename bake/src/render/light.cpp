#include "render/light.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "ambient/ambient_occlusion.h"
#include "common/vec3d.h"
#include "galactic/bake/triangle_mesh.h"
#include "render/mesh_optimizer.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// Triangles that meet with normals less than 40 degrees apart belong to one surface, which bends
/// there.
constexpr double kCosineOfBend = 0.766;
/// Rays per point. All points use the same pattern, so neighbors have similar errors, which are not
/// visible.
constexpr unsigned kRays = 64;
/// If the front gets less than this share of the light, the back is measured, too, because the
/// front may be the inside of something.
constexpr double kDim = 0.25;
/// The share of light that remains where everything is occluded.
constexpr double kDarkest = 0.3;
/// If more triangle corners than this meet, they all share one point.
constexpr std::size_t kMostMeeting = 256;

/// All pieces of a part as one mesh, which occludes the light.
struct LitMesh {
  PartMesh mesh;
  /// First triangle of each piece, and the total number.
  std::vector<std::size_t> first_triangle;
};

LitMesh joined(const std::vector<FinishedPiece>& pieces) {
  LitMesh all;
  for (const FinishedPiece& piece : pieces) {
    all.first_triangle.push_back(all.mesh.triangles.size());
    const auto first = static_cast<std::uint32_t>(all.mesh.vertices.size());
    all.mesh.vertices.insert(all.mesh.vertices.end(), piece.mesh.vertices.begin(),
                             piece.mesh.vertices.end());
    for (const Triangle& t : piece.mesh.triangles) {
      all.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  all.first_triangle.push_back(all.mesh.triangles.size());
  return all;
}

/// A triangle's unit normal (zero if it has no area) and its area.
struct Facing {
  Vec3d normal;
  double area = 0;
};

std::vector<Facing> facings(const PartMesh& mesh) {
  std::vector<Facing> all;
  all.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = widen(mesh.vertices[t[0]].position);
    const Vec3d across =
        cross(widen(mesh.vertices[t[1]].position) - a, widen(mesh.vertices[t[2]].position) - a);
    all.push_back({normalized(across, {0, 0, 0}), norm(across) / 2});
  }
  return all;
}

/// The points at which light is measured: one for each surface at a position.
class LightPoints {
 public:
  explicit LightPoints(const PartMesh& mesh)
      : facings_(facings(mesh)), of_triangle_(mesh.triangles.size()) {
    std::vector<Vec3> positions;
    positions.reserve(mesh.vertices.size());
    for (const RenderVertex& vertex : mesh.vertices) positions.push_back(vertex.position);
    const ByteNumbers places = numberValues(positions);
    // Corners by position, in the order of the triangles.
    std::vector<std::vector<Corner>> corners(places.count);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::uint32_t c = 0; c < 3; ++c) {
        corners[places.number_of[mesh.triangles[t][c]]].push_back({t, c});
      }
    }
    for (const std::vector<Corner>& meeting : corners) {
      if (meeting.empty()) continue;
      number(meeting);
      const auto [triangle, corner] = meeting.front();
      positions_.resize(normals_.size(), positions[mesh.triangles[triangle][corner]]);
    }
  }

  /// Indices of the points for the corners of each triangle.
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return of_triangle_; }
  [[nodiscard]] const std::vector<Vec3>& positions() const { return positions_; }
  /// Mean of the triangles' normals, weighted with their area; not of unit length.
  [[nodiscard]] const std::vector<Vec3d>& normals() const { return normals_; }

 private:
  /// A triangle and the number of its corner, 0 to 2.
  using Corner = std::pair<std::uint32_t, std::uint32_t>;

  std::uint32_t& pointOf(const Corner& corner) { return of_triangle_[corner.first][corner.second]; }

  /// Whether the surface continues from one triangle to another.
  [[nodiscard]] bool bends(const Corner& from, const Corner& to) const {
    return dot(facings_[from.first].normal, facings_[to.first].normal) >= kCosineOfBend;
  }

  /// Assigns one point to corners that are joined through bends.
  void number(const std::vector<Corner>& meeting) {
    constexpr std::uint32_t kUnset = 0xFFFFFFFF;
    const bool all = meeting.size() > kMostMeeting;
    for (const Corner& corner : meeting) pointOf(corner) = kUnset;
    for (const Corner& first : meeting) {
      if (pointOf(first) != kUnset) continue;
      const auto point = static_cast<std::uint32_t>(normals_.size());
      normals_.emplace_back();
      std::vector<Corner> reached{first};
      pointOf(first) = point;
      for (std::size_t n = 0; n < reached.size(); ++n) {
        const Corner from = reached[n];
        const Facing& facing = facings_[from.first];
        normals_.back() = normals_.back() + facing.normal * facing.area;
        if (all && n > 0) continue;
        for (const Corner& to : meeting) {
          if (pointOf(to) != kUnset || !(all || bends(from, to))) continue;
          pointOf(to) = point;
          reached.push_back(to);
        }
      }
    }
  }

  std::vector<Facing> facings_;
  std::vector<Triangle> of_triangle_;
  std::vector<Vec3> positions_;
  std::vector<Vec3d> normals_;
};

/// The pieces of a part that are being lit.
struct Scene {
  const std::vector<FinishedPiece>& pieces;
  const RenderSource& source;
  const std::vector<bool>& lit;
  LitMesh all;
};

/// The sides on which a triangle of a piece is lit.
LitSides sidesOf(const Scene& scene, const FinishedPiece& piece, const Triangle& triangle) {
  const std::uint16_t material = piece.mesh.vertices[triangle[0]].surface.material;
  if (!scene.lit[material]) return LitSides::kNone;
  const bool both = scene.source.materials[material].two_sided && !piece.has_outside;
  return both ? LitSides::kBoth : LitSides::kFront;
}

/// Measures the openness of each point.
Result<std::vector<Openness>> measure(const Scene& scene, const LightPoints& points,
                                      const RenderBakeOptions& options, unsigned threads) {
  constexpr std::size_t kKinds = 3;
  std::array<std::vector<Triangle>, kKinds> triangles;
  std::size_t number = 0;
  for (const FinishedPiece& piece : scene.pieces) {
    for (const Triangle& triangle : piece.mesh.triangles) {
      const auto kind = static_cast<std::size_t>(sidesOf(scene, piece, triangle));
      triangles[kind].push_back(points.triangles()[number++]);
    }
  }
  std::array<OccludingMesh, kKinds> meshes;
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    meshes[kind].positions = points.positions();
    meshes[kind].triangles = triangles[kind];
    meshes[kind].lit = static_cast<LitSides>(kind);
  }
  AmbientOcclusionOptions rays;
  rays.rays = kRays;
  rays.dim = kDim;
  rays.least_distance = std::min(static_cast<float>(2 * options.error), rays.largest_distance / 2);
  ASSIGN_OR_RETURN(auto measured, ambientOcclusion(meshes, rays, threads));
  // A point belongs to only one kind, unless kinds meet without an edge.
  std::vector<Openness> openness = std::move(measured[static_cast<std::size_t>(LitSides::kBoth)]);
  const auto& front = measured[static_cast<std::size_t>(LitSides::kFront)];
  for (const Triangle& triangle : triangles[static_cast<std::size_t>(LitSides::kFront)]) {
    for (const std::uint32_t point : triangle) openness[point] = front[point];
  }
  return openness;
}

/// Applies only the linear part of `m` to a direction.
Vec3d turned(const Affine& m, const Vec3d& v) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
          m[8] * v.x + m[9] * v.y + m[10] * v.z};
}

/// Linear light at a point.
double lightAt(const Vec3d& normal, const Openness& openness) {
  const auto front = static_cast<double>(openness.front);
  const auto back = static_cast<double>(openness.back);
  // Use the side that more light reaches, with a smooth transition, so that no seam shows where the
  // openness of a front is near kDim.
  const double bright = std::min(front / kDim, 1.0);
  const double share = back > 0 ? bright + (1 - bright) * front / (front + back) : 1;
  const auto side = [](const Vec3d& n, double open) {
    return lightByNormal({n.x, n.y, n.z}) * (kDarkest + (1 - kDarkest) * open);
  };
  return share * side(normal, front) + (1 - share) * side(-normal, back);
}

std::uint32_t colorTimes(std::uint32_t color, std::uint32_t light) {
  std::uint32_t product = color & 0xFF000000U;
  for (unsigned shift = 0; shift < 24; shift += 8) {
    const std::uint32_t value = (color >> shift & 0xFFU) * (light >> shift & 0xFFU);
    product |= (value + 127) / 255 << shift;
  }
  return product;
}

/// Multiplies the colors of a piece's corners by the light at their points. Corners of unlit
/// materials keep their colors.
void paint(PartMesh& mesh, std::span<const Triangle> points,
           const std::vector<std::uint32_t>& light, const std::vector<bool>& lit) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> painted;
  std::vector<RenderVertex> vertices;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint32_t& corner = mesh.triangles[t][c];
      const RenderVertex& vertex = mesh.vertices[corner];
      const bool is_lit = lit[vertex.surface.material];
      const std::uint32_t point = is_lit ? points[t][c] : 0;
      const auto [entry, fresh] =
          painted.try_emplace({corner, point}, static_cast<std::uint32_t>(vertices.size()));
      if (fresh) {
        vertices.push_back(vertex);
        if (is_lit) vertices.back().color = colorTimes(vertex.color, light[point]);
      }
      corner = entry->second;
    }
  }
  mesh.vertices = std::move(vertices);
}

}  // namespace

std::vector<bool> litMaterials(const RenderSource& source, Lighting lighting) {
  std::vector<bool> lit(source.materials.size(), lighting != Lighting::kNone);
  if (lighting != Lighting::kAuto || !source.may_hold_light) return lit;
  for (std::size_t n = 0; n < lit.size(); ++n) {
    if (source.baked.materials[n].texture >= 0) lit[n] = false;
  }
  for (const RenderPart& part : source.parts) {
    for (const PlacedMesh& placed : part.meshes) {
      if (!placed.mesh->colors.empty() && placed.material < lit.size()) {
        lit[placed.material] = false;
      }
    }
  }
  return lit;
}

double lightByNormal(const std::array<double, 3>& normal) {
  // Light from the sky, from one side of the sky, and from everywhere.
  constexpr double kSky = 0.25;
  constexpr double kKey = 0.4;
  constexpr double kEverywhere = 0.3;
  constexpr std::array<double, 3> kKeyDirection{0.58, 0.757, 0.3};
  const double key =
      normal[0] * kKeyDirection[0] + normal[1] * kKeyDirection[1] + normal[2] * kKeyDirection[2];
  return kEverywhere + kSky * (0.5 + 0.5 * normal[1]) + kKey * (0.5 + 0.5 * key);
}

Result<void> lightPieces(std::vector<FinishedPiece>& pieces, const RenderPart& part,
                         const RenderSource& source, const RenderBakeOptions& options,
                         unsigned threads) {
  const std::vector<bool> lit = litMaterials(source, options.lighting);
  const Scene scene{pieces, source, lit, joined(pieces)};
  const LightPoints points(scene.all.mesh);
  ASSIGN_OR_RETURN(const auto openness, measure(scene, points, options, threads));
  std::vector<std::uint32_t> light;
  light.reserve(openness.size());
  for (std::size_t n = 0; n < openness.size(); ++n) {
    const Vec3d normal = normalized(turned(part.light_from_part, points.normals()[n]), {0, 1, 0});
    const auto level = static_cast<float>(lightAt(normal, openness[n]));
    light.push_back(surfaceColor({level, level, level, 1}));
  }
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    const std::size_t first = scene.all.first_triangle[n];
    const std::span all(points.triangles());
    paint(pieces[n].mesh, all.subspan(first, pieces[n].mesh.triangles.size()), light, lit);
  }
  return {};
}

}  // namespace galactic::bake
