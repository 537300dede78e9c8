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

#include "galactic/render_layout.h"
#include "galactic/render_mesh_builder.h"
#include "render/cluster_bounds.h"
#include "render/cluster_split.h"

namespace galactic {
namespace {

using render::ClusterBounds;
using render::ClusterDraft;

constexpr std::size_t kTextureAlignment = 32;
/// The most that sixteen bits hold.
constexpr std::int64_t kMostStored = std::numeric_limits<std::uint16_t>::max();
constexpr double kFinestStep = 1.0 / (1 << 14);
constexpr double kCoarsestStep = 1;
/// Lattice numbers up to here are floats.
constexpr std::int64_t kMostLattice = std::int64_t{1} << 24U;
/// Farthest from the origin of its part that a vertex may be, metres.
constexpr float kFarthest = 65536;

bool isFinite(const RenderVertex& vertex) {
  return std::isfinite(vertex.u) && std::isfinite(vertex.v) && std::isfinite(vertex.position.x) &&
         std::isfinite(vertex.position.y) && std::isfinite(vertex.position.z);
}

bool isNear(const Vec3& p) {
  return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest;
}

/// What is wrong with a surface, as a sentence; nothing when it can be stored.
std::optional<std::string> faultOf(const RenderSurface& surface, const RenderMeshSource& source) {
  // A cluster then repeats its image 32,000 times at most, which a pack can hold.
  constexpr float kLargestTexture = 16000;
  if (surface.corners.size() % 3 != 0) {
    return fmt::format("found {} corners, wanted three per triangle", surface.corners.size());
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
    if (std::abs(vertex.u) > kLargestTexture || std::abs(vertex.v) > kLargestTexture) {
      return fmt::format("found texture coordinates ({}, {}) at vertex {}, wanted at most {}",
                         vertex.u, vertex.v, n, kLargestTexture);
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
                    fmt::format("found part {} after part {}, wanted them to ascend", part.part,
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
      return refuse(where, fmt::format("found a size of {}, wanted a power of two", texture.size));
    }
    const std::size_t wanted = textureBytes(texture.size, texture.format);
    if (texture.texels.size() != wanted) {
      return refuse(
          where, fmt::format("found {} bytes of texels, wanted {}", texture.texels.size(), wanted));
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

/// A draft and the surface that it is of.
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

/// Where a cluster's vertices are on the lattice.
struct LatticeBox {
  LatticePoint low;
  LatticePoint high;

  /// Whether a cluster in it can be stored.
  [[nodiscard]] bool fits() const {
    const std::int64_t extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    return extent <= kMostStored && std::min({low.x, low.y, low.z}) >= -kMostLattice &&
           std::max({low.x, low.y, low.z}) < kMostLattice - kMostStored;
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

/// The finest step on which every cluster can be stored; none when there is none.
std::optional<double> latticeStep(const std::vector<SurfaceDraft>& clusters) {
  double step = kFinestStep;
  for (const SurfaceDraft& cluster : clusters) {
    while (!latticeBox(cluster, step).fits()) step *= 2;
  }
  return step <= kCoarsestStep ? std::optional(step) : std::nullopt;
}

/// How a texture coordinate of a cluster is stored.
struct TextureRange {
  double whole = 0;
  float minimum = 0;
  float step = 0;

  template <class Get>
  TextureRange(const SurfaceDraft& cluster, const Get& get) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const std::uint32_t vertex : cluster.draft.vertices) {
      const auto value = static_cast<double>(get(cluster.surface->vertices[vertex]));
      low = std::min(low, value);
      high = std::max(high, value);
    }
    whole = std::floor(low);
    minimum = static_cast<float>(low - whole);
    step = static_cast<float>((high - low) / static_cast<double>(kMostStored));
  }

  [[nodiscard]] std::uint16_t stored(float value) const {
    if (!(step > 0)) return 0;
    const double steps = (static_cast<double>(value) - whole - static_cast<double>(minimum)) /
                         static_cast<double>(step);
    return static_cast<std::uint16_t>(std::clamp<double>(std::round(steps), 0, kMostStored));
  }
};

/// Appends clusters to the pools.
class Packer {
 public:
  explicit Packer(RenderMeshStorage& storage) : out_(storage) {}

  /// `step`: from latticeStep().
  void add(const RenderPart& part, const std::vector<SurfaceDraft>& clusters, double step) {
    RenderModel model;
    model.part = part.part;
    model.step = static_cast<float>(step);
    model.first_cluster = static_cast<std::uint32_t>(out_.clusters.size());
    model.cluster_count = static_cast<std::uint32_t>(clusters.size());
    model.first_block =
        static_cast<std::uint32_t>(out_.cluster_bounds.size() / (kBoundsRows * kRenderLanes));
    model.source_triangles = part.source_triangles;
    model.largest_error = part.largest_error;
    addEmptyBounds(wholeLanes(clusters.size()) / kRenderLanes);
    for (std::size_t n = 0; n < clusters.size(); ++n) {
      addCluster(clusters[n], model);
      growBox(model, n == 0);
      model.triangles += out_.clusters.back().triangle_count;
      storeBounds(model, n, clusters[n]);
    }
    out_.models.push_back(model);
  }

  /// After the last part.
  void finish() {
    if (!has_colors_) out_.colors.clear();
  }

 private:
  void addEmptyBounds(std::size_t blocks) {
    constexpr std::array<float, kBoundsRows> kEmpty{
        0, 0, 0, kNoCluster, kNoCluster, kNoCluster, kNoCluster, 0, 0, 0, 0};
    for (std::size_t block = 0; block < blocks; ++block) {
      for (const float value : kEmpty) {
        out_.cluster_bounds.insert(out_.cluster_bounds.end(), kRenderLanes, value);
      }
    }
  }

  void addCluster(const SurfaceDraft& cluster, const RenderModel& model) {
    const RenderSurface& surface = *cluster.surface;
    const ClusterDraft& draft = cluster.draft;
    const auto step = static_cast<double>(model.step);
    const LatticePoint origin = latticeBox(cluster, step).low;
    const TextureRange u(cluster, [](const RenderVertex& vertex) { return vertex.u; });
    const TextureRange v(cluster, [](const RenderVertex& vertex) { return vertex.v; });
    RenderCluster stored;
    stored.origin_x = static_cast<std::int32_t>(origin.x);
    stored.origin_y = static_cast<std::int32_t>(origin.y);
    stored.origin_z = static_cast<std::int32_t>(origin.z);
    stored.u_minimum = u.minimum;
    stored.v_minimum = v.minimum;
    stored.u_step = u.step;
    stored.v_step = v.step;
    stored.first_vertex = static_cast<std::uint32_t>(out_.colors.size());
    stored.first_triangle = static_cast<std::uint32_t>(out_.triangles.size() / kTriangleRows);
    stored.vertex_count = static_cast<std::uint16_t>(draft.vertices.size());
    stored.triangle_count = static_cast<std::uint16_t>(draft.triangles.size());
    stored.material = surface.material;
    stored.semantic = surface.semantic;
    stored.two_sided = surface.two_sided ? 1 : 0;
    out_.clusters.push_back(stored);

    const std::size_t room = wholeLanes(draft.vertices.size());
    out_.vertices.resize(out_.vertices.size() + room * kVertexRows);
    out_.colors.resize(out_.colors.size() + room);
    positions_.clear();
    for (std::size_t n = 0; n < draft.vertices.size(); ++n) {
      const RenderVertex& vertex = surface.vertices[draft.vertices[n]];
      const LatticePoint p = latticePoint(vertex.position, step);
      storeVertex(
          stored.first_vertex + n,
          {static_cast<std::uint16_t>(p.x - origin.x), static_cast<std::uint16_t>(p.y - origin.y),
           static_cast<std::uint16_t>(p.z - origin.z), u.stored(vertex.u), v.stored(vertex.v)});
      out_.colors[stored.first_vertex + n] = vertex.color;
      has_colors_ |= vertex.color != 0xFFFFFFFFU;
      positions_.push_back({static_cast<float>(p.x) * model.step,
                            static_cast<float>(p.y) * model.step,
                            static_cast<float>(p.z) * model.step});
    }
    addTriangles(draft);
  }

  void storeVertex(std::size_t number, const std::array<std::uint16_t, kVertexRows>& values) {
    for (std::size_t row = 0; row < kVertexRows; ++row) {
      out_.vertices[pooledAt(number, row, kVertexRows)] = values[row];
    }
  }

  void addTriangles(const ClusterDraft& draft) {
    const std::size_t first = out_.triangles.size() / kTriangleRows;
    out_.triangles.resize(out_.triangles.size() +
                          wholeLanes(draft.triangles.size()) * kTriangleRows);
    for (std::size_t n = 0; n < draft.triangles.size(); ++n) {
      for (std::size_t row = 0; row < kTriangleRows; ++row) {
        out_.triangles[pooledAt(first + n, row, kTriangleRows)] = draft.triangles[n][row];
      }
    }
  }

  /// By the vertices of the cluster that was added last.
  void growBox(RenderModel& model, bool is_first) const {
    if (is_first) model.bounds_min = model.bounds_max = positions_[0];
    Vec3& low = model.bounds_min;
    Vec3& high = model.bounds_max;
    for (const Vec3& p : positions_) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }

  void storeBounds(const RenderModel& model, std::size_t cluster, const SurfaceDraft& source) {
    const std::span<const std::array<std::uint8_t, 3>> triangles = source.draft.triangles;
    const ClusterBounds b =
        render::boundsOf(positions_, source.surface->two_sided ? triangles.first(0) : triangles);
    const std::array<float, kBoundsRows> rows{
        b.centre.x, b.centre.y, b.centre.z, b.half_extents.x, b.half_extents.y, b.half_extents.z,
        b.radius,   b.axis.x,   b.axis.y,   b.axis.z,         b.cutoff};
    const std::size_t lane = model.first_block * kRenderLanes + cluster;
    for (std::size_t row = 0; row < kBoundsRows; ++row) {
      out_.cluster_bounds[pooledAt(lane, row, kBoundsRows)] = rows[row];
    }
  }

  RenderMeshStorage& out_;
  /// As they are drawn, of the cluster that was added last.
  std::vector<Vec3> positions_;
  bool has_colors_ = false;
};

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
  RenderMeshes meshes;
  meshes.models = models;
  meshes.clusters = clusters;
  meshes.cluster_bounds = cluster_bounds;
  meshes.vertices = vertices;
  meshes.colors = colors;
  meshes.triangles = triangles;
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
  Packer packer(storage);
  for (std::size_t p = 0; p < source.parts.size(); ++p) {
    const std::vector<SurfaceDraft> clusters = draftsOf(source.parts[p]);
    const std::optional<double> step = latticeStep(clusters);
    if (!step) {
      return refuse(
          fmt::format("parts[{}]", p),
          fmt::format("found a cluster longer than {} m, wanted a smaller one", kMostStored));
    }
    packer.add(source.parts[p], clusters, *step);
  }
  packer.finish();
  return storage;
}

}  // namespace galactic
