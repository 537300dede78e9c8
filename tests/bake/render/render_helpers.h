#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "galactic/bake/render_baker.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/oracles/render_mesh_reader.h"

namespace galactic::test {

inline constexpr bake::Affine kHere{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

inline bake::Affine movedBy(double x, double y, double z) {
  return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z};
}

/// Collects what a bake of render meshes takes. Meshes are placed in the part added last.
class SourceBuilder {
 public:
  SourceBuilder() {
    source_.semantics = {"thing"};
    source_.parts.emplace_back();
  }

  std::uint32_t material(bool two_sided, bool textured = false, float alpha_cutoff = 0) {
    bake::SourceMaterial& material = source_.materials.emplace_back();
    material.name = "material " + std::to_string(source_.materials.size());
    material.two_sided = two_sided;
    bake::BakedMaterials& baked = source_.baked;
    bake::BakedMaterial stored;
    stored.name = material.name;
    stored.alpha_cutoff = alpha_cutoff;
    if (textured) {
      bake::BakedTexture texture;
      texture.name = material.name;
      texture.size = 1;
      texture.first_byte = static_cast<std::uint32_t>(32 * baked.textures.size());
      baked.texels.resize(texture.first_byte, 0);
      baked.texels.resize(texture.first_byte + 4, static_cast<std::uint8_t>(baked.textures.size()));
      stored.texture = static_cast<std::int32_t>(baked.textures.size());
      baked.textures.push_back(texture);
    }
    baked.materials.push_back(stored);
    return static_cast<std::uint32_t>(source_.materials.size() - 1);
  }

  std::uint32_t semantic(const std::string& name) {
    source_.semantics.push_back(name);
    return static_cast<std::uint32_t>(source_.semantics.size() - 1);
  }

  SourceBuilder& part(std::uint32_t number) {
    if (source_.parts.back().meshes.empty()) source_.parts.pop_back();
    source_.parts.push_back({.part = number, .meshes = {}});
    return *this;
  }

  SourceBuilder& place(bake::SourceMesh mesh, std::uint32_t material,
                       const bake::Affine& part_from_mesh = kHere, std::uint32_t semantic = 0) {
    source_.own_meshes.push_back(std::make_unique<bake::SourceMesh>(std::move(mesh)));
    source_.parts.back().meshes.push_back({.mesh = source_.own_meshes.back().get(),
                                           .part_from_mesh = part_from_mesh,
                                           .material = material,
                                           .semantic = semantic});
    return *this;
  }

  [[nodiscard]] const bake::RenderSource& source() const { return source_; }
  [[nodiscard]] bake::RenderSource& source() { return source_; }

 private:
  bake::RenderSource source_;
};

inline bake::SourceMesh meshOf(const bake::TriangleMesh& mesh, const std::string& name = "mesh") {
  bake::SourceMesh source;
  source.name = name;
  source.positions = mesh.vertices;
  source.triangles = mesh.triangles;
  return source;
}

/// The mesh with all triangles turned round.
inline bake::SourceMesh insideOut(bake::SourceMesh mesh) {
  for (bake::Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

using LatticePoint = std::array<std::int64_t, 3>;

/// How often edges, by lattice points, are passed one way more than the other, in all: 0 for what
/// has no crack. Knows nothing of how a bake welds.
inline std::size_t openEdges(const std::vector<DrawnTriangle>& triangles) {
  std::map<std::pair<LatticePoint, LatticePoint>, int> passes;
  for (const DrawnTriangle& triangle : triangles) {
    for (std::size_t n = 0; n < 3; ++n) {
      const LatticePoint& from = triangle.corners[n].at;
      const LatticePoint& to = triangle.corners[(n + 1) % 3].at;
      if (from < to) {
        ++passes[{from, to}];
      } else {
        --passes[{to, from}];
      }
    }
  }
  std::size_t open = 0;
  for (const auto& [edge, count] : passes) open += static_cast<std::size_t>(std::abs(count));
  return open;
}

/// Volume that the triangles enclose, seen from outside; cubic meters.
inline double enclosedVolume(const std::vector<DrawnTriangle>& triangles) {
  double volume = 0;
  for (const DrawnTriangle& triangle : triangles) {
    const auto& a = triangle.corners[0].position;
    const auto& b = triangle.corners[1].position;
    const auto& c = triangle.corners[2].position;
    volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0])) /
              6;
  }
  return volume;
}

inline std::size_t twoSidedCount(const std::vector<DrawnTriangle>& triangles) {
  return static_cast<std::size_t>(std::count_if(
      triangles.begin(), triangles.end(), [](const DrawnTriangle& t) { return t.two_sided; }));
}

/// The drawn triangles as a mesh.
inline bake::TriangleMesh asMesh(const std::vector<DrawnTriangle>& triangles) {
  bake::TriangleMesh mesh;
  for (const DrawnTriangle& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const DrawnCorner& corner : triangle.corners) {
      mesh.vertices.push_back({static_cast<float>(corner.position[0]),
                               static_cast<float>(corner.position[1]),
                               static_cast<float>(corner.position[2])});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  if (mesh.vertices.empty()) return mesh;
  mesh.bounds = {mesh.vertices.front(), mesh.vertices.front()};
  for (const Vec3& v : mesh.vertices) {
    Vec3& lo = mesh.bounds.min;
    Vec3& hi = mesh.bounds.max;
    lo = {std::min(lo.x, v.x), std::min(lo.y, v.y), std::min(lo.z, v.z)};
    hi = {std::max(hi.x, v.x), std::max(hi.y, v.y), std::max(hi.z, v.z)};
  }
  return mesh;
}

}  // namespace galactic::test
