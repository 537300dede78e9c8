#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "galactic/bake/triangle_mesh.h"
#include "import/affine.h"
#include "render/mesh_optimizer.h"
#include "render/part_mesh.h"
#include "support/out_of_memory.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// Adding 0 turns -0 into 0: different bytes for the same number must not keep vertices apart.
Vec3 rounded(const std::array<double, 3>& p) {
  return {static_cast<float>(p[0]) + 0.0F, static_cast<float>(p[1]) + 0.0F,
          static_cast<float>(p[2]) + 0.0F};
}

bool canBePlaced(const std::array<double, 3>& p) {
  // Comparisons with NaN are false.
  return std::all_of(p.begin(), p.end(),
                     [](double value) { return std::abs(value) <= kMaxCoordinate; });
}

/// Texture coordinates with v down from the top of the image; {0, 0} if they are not finite.
std::array<float, 2> imageUv(const std::array<float, 2>& uv) {
  if (!std::isfinite(uv[0]) || !std::isfinite(uv[1])) return {0, 0};
  return {uv[0] + 0.0F, 1.0F - uv[1]};
}

/// The color without its alpha, because only the texture's alpha cuts out parts.
std::uint32_t opaqueColor(const std::array<float, 4>& linear) {
  constexpr std::uint32_t kOpaque = 0xFF000000;
  return surfaceColor(linear) | kOpaque;
}

Result<void> appendPlaced(const PlacedMesh& placed, const RenderSource& source, PartMesh& to) {
  const SourceMesh& mesh = *placed.mesh;
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  const bool textured = source.baked.materials[placed.material].texture >= 0 && !mesh.uvs.empty();
  for (std::size_t n = 0; n < mesh.positions.size(); ++n) {
    RenderVertex& vertex = to.vertices.emplace_back();
    vertex.surface = {static_cast<std::uint16_t>(placed.material),
                      static_cast<std::uint16_t>(placed.semantic)};
    const auto position = transformed(placed.part_from_mesh, mesh.positions[n]);
    if (!canBePlaced(position)) {
      return fail(ErrorCode::kInvalidInput, fmt::format("mesh '{}'", mesh.name),
                  fmt::format("vertex {} is at ({}, {}, {}) m, at most {} m are possible; is the "
                              "unit meters?",
                              n, position[0], position[1], position[2], kMaxCoordinate));
    }
    vertex.position = rounded(position);
    if (textured) vertex.uv = imageUv(mesh.uvs[n]);
    if (!mesh.colors.empty()) vertex.color = opaqueColor(mesh.colors[n]);
  }
  const bool mirrors = determinant(placed.part_from_mesh) < 0;
  for (const Triangle& triangle : mesh.triangles) {
    Triangle moved{first + triangle[0], first + triangle[1], first + triangle[2]};
    if (mirrors) std::swap(moved[1], moved[2]);
    to.triangles.push_back(moved);
  }
  return {};
}

/// The same triangle, rotated so that its least index comes first; keeps the winding.
Triangle turned(const Triangle& t) {
  if (t[0] <= t[1] && t[0] <= t[2]) return t;
  if (t[1] <= t[2]) return {t[1], t[2], t[0]};
  return {t[2], t[0], t[1]};
}

/// Removes duplicates, keeping the first of equal triangles.
void dropRepeated(std::vector<Triangle>& triangles) {
  std::vector<std::pair<Triangle, std::uint32_t>> order;
  order.reserve(triangles.size());
  for (const Triangle& triangle : triangles) {
    order.emplace_back(turned(triangle), static_cast<std::uint32_t>(order.size()));
  }
  std::sort(order.begin(), order.end());
  std::vector<bool> repeated(triangles.size());
  for (std::size_t n = 1; n < order.size(); ++n) {
    repeated[order[n].second] = order[n].first == order[n - 1].first;
  }
  std::size_t kept = 0;
  for (std::size_t n = 0; n < triangles.size(); ++n) {
    if (!repeated[n]) triangles[kept++] = triangles[n];
  }
  triangles.resize(kept);
}

/// Memory that a vertex and a triangle take until they are welded, as measured on 180 million
/// vertices.
constexpr double kBytesPerVertex = 50;
constexpr double kBytesPerTriangle = 40;

/// Reserves memory for all meshes of a part at once. Otherwise the vectors would move their content
/// again and again, as a part may have 200,000 meshes.
Result<PartMesh> emptyMesh(const RenderPart& part) {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  for (const PlacedMesh& placed : part.meshes) {
    vertices += placed.mesh->positions.size();
    triangles += placed.mesh->triangles.size();
  }
  RETURN_IF_ERROR(checkMemory(kBytesPerVertex * static_cast<double>(vertices) +
                                  kBytesPerTriangle * static_cast<double>(triangles),
                              fmt::format("render meshes of {} vertices", vertices),
                              "simplify the meshes, or leave out what is drawn "
                              "(`no-render-meshes`)"));
  PartMesh mesh;
  mesh.vertices.reserve(vertices);
  mesh.triangles.reserve(triangles);
  return mesh;
}

bool coincide(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

void weld(PartMesh& mesh) {
  const ByteNumbers numbers = numberValues(mesh.vertices);
  mesh.vertices = distinctValues(mesh.vertices, numbers);
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) corner = numbers.number_of[corner];
  }
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    const Vec3& a = mesh.vertices[t[0]].position;
    const Vec3& b = mesh.vertices[t[1]].position;
    const Vec3& c = mesh.vertices[t[2]].position;
    return coincide(a, b) || coincide(b, c) || coincide(c, a);
  });
  dropRepeated(mesh.triangles);
}

/// Disjoint sets of vertices, joined by triangles (Tarjan).
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    for (std::size_t n = 0; n < count; ++n) parent_[n] = static_cast<std::uint32_t>(n);
  }
  std::uint32_t find(std::uint32_t n) {
    while (parent_[n] != n) {
      parent_[n] = parent_[parent_[n]];
      n = parent_[n];
    }
    return n;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace

Result<PartMesh> assemblePart(const RenderPart& part, const RenderSource& source) {
  ASSIGN_OR_RETURN(auto mesh, emptyMesh(part));
  for (const PlacedMesh& placed : part.meshes) {
    if (placed.material >= source.materials.size() || placed.semantic >= source.semantics.size()) {
      return fail(ErrorCode::kInvalidInput, fmt::format("mesh '{}'", placed.mesh->name),
                  fmt::format("has material {} of {} and semantic {} of {}; export the file again",
                              placed.material, source.materials.size(), placed.semantic,
                              source.semantics.size()));
    }
    RETURN_IF_ERROR(appendPlaced(placed, source, mesh));
  }
  weld(mesh);
  return mesh;
}

std::vector<PartMesh> connectedPieces(const PartMesh& mesh) {
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  std::vector<Vec3> positions;
  positions.reserve(mesh.vertices.size());
  for (const RenderVertex& vertex : mesh.vertices) positions.push_back(vertex.position);
  const ByteNumbers numbers = numberValues(positions);
  Sets sets(numbers.count);
  for (const Triangle& t : mesh.triangles) {
    sets.join(numbers.number_of[t[0]], numbers.number_of[t[1]]);
    sets.join(numbers.number_of[t[0]], numbers.number_of[t[2]]);
  }
  std::vector<PartMesh> pieces;
  std::vector<std::uint32_t> piece_of(numbers.count, kNone);
  // Each vertex belongs to only one piece, so all pieces can share one table.
  std::vector<std::uint32_t> moved_to(mesh.vertices.size(), kNone);
  for (const Triangle& triangle : mesh.triangles) {
    std::uint32_t& number = piece_of[sets.find(numbers.number_of[triangle[0]])];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(pieces.size());
      pieces.emplace_back();
    }
    PartMesh& piece = pieces[number];
    Triangle& moved = piece.triangles.emplace_back(triangle);
    for (std::uint32_t& corner : moved) {
      std::uint32_t& to = moved_to[corner];
      if (to == kNone) {
        to = static_cast<std::uint32_t>(piece.vertices.size());
        piece.vertices.push_back(mesh.vertices[corner]);
      }
      corner = to;
    }
  }
  return pieces;
}

}  // namespace galactic::bake
