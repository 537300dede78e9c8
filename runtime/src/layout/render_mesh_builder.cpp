#include "layout/render_mesh_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "layout/cluster_split.h"

namespace galactic {
namespace {

using render::ClusterDraft;

constexpr std::size_t kTextureAlignment = 32;
constexpr double kCoarsestStep = 1;
/// Lattice coordinates up to this are exact as floats.
constexpr std::int64_t kMostLattice = std::int64_t{1} << 24U;
/// Farthest that a vertex may be from the origin of its part, meters.
constexpr float kFarthest = 65536;

bool isFinite(const RenderVertex& vertex) {
  return std::isfinite(vertex.u) && std::isfinite(vertex.v) && std::isfinite(vertex.position.x) &&
         std::isfinite(vertex.position.y) && std::isfinite(vertex.position.z);
}

bool isNear(const Vec3& p) {
  return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest;
}

/// What is wrong with a surface, as a sentence; none if it can be stored.
std::optional<std::string> faultOf(const RenderSurface& surface, const RenderMeshSource& source) {
  if (surface.corners.size() % 3 != 0) {
    return fmt::format("found {} corners, expected three per triangle", surface.corners.size());
  }
  if (surface.material >= source.materials.size()) {
    return fmt::format("found material {} of {}", surface.material, source.materials.size());
  }
  if (surface.semantic >= source.semantics.size()) {
    return fmt::format("found semantic {} of {}", surface.semantic, source.semantics.size());
  }
  for (const std::uint32_t corner : surface.corners) {
    if (corner < surface.vertices.size()) continue;
    return fmt::format("found corner {} of {} vertices", corner, surface.vertices.size());
  }
  for (std::size_t n = 0; n < surface.vertices.size(); ++n) {
    const RenderVertex& vertex = surface.vertices[n];
    if (!isFinite(vertex)) return fmt::format("found a vertex {} that is not finite", n);
    if (!isNear(vertex.position)) {
      return fmt::format("found a vertex {} farther than {} m from the origin, which fits no pack",
                         n, kFarthest);
    }
    if (std::abs(vertex.u) > kMostImages || std::abs(vertex.v) > kMostImages) {
      return fmt::format("found texture coordinates ({}, {}) at vertex {}, expected at most {}",
                         vertex.u, vertex.v, n, kMostImages);
    }
  }
  return std::nullopt;
}

tl::unexpected<Error> refuse(const std::string& where, const std::string& message) {
  return fail(ErrorCode::kInvalidInput, "render meshes: " + where, message);
}

Result<void> checkParts(const RenderMeshSource& source) {
  for (std::size_t p = 0; p < source.parts.size(); ++p) {
    const RenderPart& part = source.parts[p];
    if (p > 0 && part.part <= source.parts[p - 1].part) {
      return refuse(fmt::format("parts[{}]", p),
                    fmt::format("found part {} after part {}, expected them to ascend", part.part,
                                source.parts[p - 1].part));
    }
    for (std::size_t s = 0; s < part.surfaces.size(); ++s) {
      if (const auto fault = faultOf(part.surfaces[s], source)) {
        return refuse(fmt::format("parts[{}].surfaces[{}]", p, s), *fault);
      }
    }
  }
  return {};
}

Result<void> checkAppearance(const RenderMeshSource& source) {
  for (std::size_t n = 0; n < source.textures.size(); ++n) {
    const RenderTexture& texture = source.textures[n];
    const std::string where = fmt::format("textures[{}]", n);
    if (!std::has_single_bit(texture.size)) {
      return refuse(where,
                    fmt::format("found a size of {}, expected a power of two", texture.size));
    }
    const std::size_t wanted = textureBytes(texture.size, texture.format);
    if (texture.texels.size() != wanted) {
      return refuse(where, fmt::format("found {} bytes of texels, expected {}",
                                       texture.texels.size(), wanted));
    }
  }
  for (std::size_t n = 0; n < source.materials.size(); ++n) {
    const std::int32_t texture = source.materials[n].texture;
    if (texture >= -1 && texture < static_cast<std::int32_t>(source.textures.size())) continue;
    return refuse(fmt::format("materials[{}]", n),
                  fmt::format("found texture {} of {}", texture, source.textures.size()));
  }
  return {};
}

/// A draft and the surface that it belongs to.
struct SurfaceDraft {
  const RenderSurface* surface = nullptr;
  ClusterDraft draft;
};

std::vector<SurfaceDraft> draftsOf(const RenderPart& part) {
  std::vector<SurfaceDraft> drafts;
  for (const RenderSurface& surface : part.surfaces) {
    for (ClusterDraft& draft : render::splitSurface(surface)) {
      drafts.push_back({&surface, std::move(draft)});
    }
  }
  return drafts;
}

/// A point of a lattice.
struct LatticePoint {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t z = 0;
};

/// The lattice box of a cluster's vertices.
struct LatticeBox {
  LatticePoint low;
  LatticePoint high;

  /// Whether a cluster of this box can be stored.
  [[nodiscard]] bool fits() const {
    const std::int64_t extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    return extent <= kMostSteps && std::min({low.x, low.y, low.z}) >= -kMostLattice &&
           std::max({low.x, low.y, low.z}) < kMostLattice - kMostSteps;
  }
};

LatticePoint latticePoint(const Vec3& p, double step) {
  return {std::llround(static_cast<double>(p.x) / step),
          std::llround(static_cast<double>(p.y) / step),
          std::llround(static_cast<double>(p.z) / step)};
}

LatticeBox latticeBox(const SurfaceDraft& cluster, double step) {
  constexpr std::int64_t kAny = std::numeric_limits<std::int32_t>::max();
  LatticeBox box{{kAny, kAny, kAny}, {-kAny, -kAny, -kAny}};
  for (const std::uint32_t vertex : cluster.draft.vertices) {
    const LatticePoint p = latticePoint(cluster.surface->vertices[vertex].position, step);
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

/// The finest step with which every cluster can be stored, if any.
std::optional<double> latticeStep(const std::vector<SurfaceDraft>& clusters) {
  double step = kFinestStep;
  for (const SurfaceDraft& cluster : clusters) {
    while (!latticeBox(cluster, step).fits()) step *= 2;
  }
  return step <= kCoarsestStep ? std::optional(step) : std::nullopt;
}

/// `step`: from latticeStep().
LatticeModel onLattice(const std::vector<SurfaceDraft>& clusters, double step) {
  LatticeModel model;
  model.step = step;
  model.clusters.reserve(clusters.size());
  for (const auto& [surface, draft] : clusters) {
    LatticeCluster& cluster = model.clusters.emplace_back();
    cluster.triangles = draft.triangles;
    cluster.material = surface->material;
    cluster.semantic = surface->semantic;
    cluster.two_sided = surface->two_sided;
    cluster.vertices.reserve(draft.vertices.size());
    for (const std::uint32_t number : draft.vertices) {
      const RenderVertex& vertex = surface->vertices[number];
      const LatticePoint p = latticePoint(vertex.position, step);
      cluster.vertices.push_back(
          {.at = {static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y),
                  static_cast<std::int32_t>(p.z)},
           .uv = {vertex.u, vertex.v},
           .color = vertex.color});
    }
  }
  return model;
}

bool hasColors(const RenderMeshSource& source) {
  constexpr std::uint32_t kWhite = 0xFFFFFFFF;
  return std::ranges::any_of(source.parts, [](const RenderPart& part) {
    return std::ranges::any_of(part.surfaces, [](const RenderSurface& surface) {
      return std::ranges::any_of(surface.vertices,
                                 [](const RenderVertex& vertex) { return vertex.color != kWhite; });
    });
  });
}

void copyAppearance(const RenderMeshSource& source, RenderMeshStorage& storage) {
  storage.materials.reserve(source.materials.size());
  for (const RenderMaterial& material : source.materials) {
    storage.materials.push_back(
        {std::string(material.name), material.color, material.texture, material.alpha_cutoff});
  }
  storage.textures.reserve(source.textures.size());
  for (const RenderTexture& texture : source.textures) {
    const std::size_t end = storage.texels.size() + kTextureAlignment - 1;
    storage.texels.resize(end / kTextureAlignment * kTextureAlignment);
    storage.textures.push_back(
        {std::string(texture.name), texture.size, texture.format, storage.texels.size()});
    storage.texels.insert(storage.texels.end(), texture.texels.begin(), texture.texels.end());
  }
  storage.semantics = source.semantics;
}

}  // namespace

RenderMeshes RenderMeshStorage::view() const {
  RenderMeshes meshes = geometry();
  meshes.materials.reserve(materials.size());
  for (const Material& material : materials) {
    meshes.materials.push_back(
        {material.name, material.color, material.texture, material.alpha_cutoff});
  }
  meshes.textures.reserve(textures.size());
  for (const Texture& texture : textures) {
    const std::size_t bytes = textureBytes(texture.size, texture.format);
    meshes.textures.push_back({texture.name, texture.size, texture.format,
                               std::span(texels).subspan(texture.first_byte, bytes)});
  }
  meshes.semantics.assign(semantics.begin(), semantics.end());
  return meshes;
}

Result<RenderMeshStorage> buildRenderMeshes(const RenderMeshSource& source) {
  if (const Result<void> checked = checkAppearance(source); !checked) {
    return tl::unexpected<Error>(checked.error());
  }
  if (const Result<void> checked = checkParts(source); !checked) {
    return tl::unexpected<Error>(checked.error());
  }
  RenderMeshStorage storage;
  copyAppearance(source, storage);
  const bool colored = hasColors(source);
  for (std::size_t p = 0; p < source.parts.size(); ++p) {
    const std::vector<SurfaceDraft> clusters = draftsOf(source.parts[p]);
    const std::optional<double> step = latticeStep(clusters);
    if (!step) {
      return refuse(
          fmt::format("parts[{}]", p),
          fmt::format("found a cluster longer than {} m, expected a smaller one", kMostSteps));
    }
    appendModel(onLattice(clusters, *step),
                {.part = source.parts[p].part,
                 .source_triangles = source.parts[p].source_triangles,
                 .largest_error = source.parts[p].largest_error,
                 .colored = colored},
                storage);
  }
  return storage;
}

}  // namespace galactic
