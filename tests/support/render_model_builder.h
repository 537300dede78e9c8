#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "galactic/pose.h"
#include "galactic/render_meshes.h"

namespace galactic::test {

/// A corner of a triangle: place in metres, texture coordinates with v down, colour.
struct RenderVertex {
  Vec3 position;
  float u = 0;
  float v = 0;
  std::uint32_t color = 0xFFFFFFFF;
};

/// What all triangles of a cluster share.
struct RenderSurface {
  std::uint16_t material = 0;
  std::uint16_t semantic = 0;
  bool two_sided = false;

  friend bool operator==(const RenderSurface&, const RenderSurface&) = default;
};

/// Makes render meshes from triangles, in the order in which they come: for tests of renderers.
/// Call model() before the triangles of each model; finish() when all are there. Owns what meshes()
/// shows; may be moved, not copied.
class RenderModelBuilder {
 public:
  /// `step`: metres between lattice points, a power of two.
  explicit RenderModelBuilder(float step = 1.0F / 4096) : step_(step) {
    semantics_ = {"thing"};
    material(0xFFFFFFFF);
  }
  RenderModelBuilder(RenderModelBuilder&&) = default;
  RenderModelBuilder& operator=(RenderModelBuilder&&) = default;
  RenderModelBuilder(const RenderModelBuilder&) = delete;
  RenderModelBuilder& operator=(const RenderModelBuilder&) = delete;

  /// Material 0 is white; others follow from 1 on. `texture`: as texture() returned it, or -1.
  std::uint16_t material(std::uint32_t color, std::int32_t texture = -1, float alpha_cutoff = 0) {
    materials_.push_back({"surface", color, texture, alpha_cutoff});
    return static_cast<std::uint16_t>(materials_.size() - 1);
  }

  /// A square texture of size x size texels, RGBA, R lowest, from the top row on; the levels below
  /// are averages of four texels each.
  std::int32_t texture(std::uint32_t size, std::vector<std::uint32_t> texels) {
    const std::uint32_t edge = size;
    std::vector<std::uint32_t> all;
    while (true) {
      all.insert(all.end(), texels.begin(), texels.end());
      if (size == 1) break;
      texels = halved(size, texels);
      size /= 2;
    }
    textures_.push_back({edge, std::make_unique<std::vector<std::uint32_t>>(std::move(all))});
    return static_cast<std::int32_t>(textures_.size() - 1);
  }

  /// Semantic 0 is there; others follow from 1 on.
  std::uint16_t semantic(std::string name) {
    semantics_.push_back(std::move(name));
    return static_cast<std::uint16_t>(semantics_.size() - 1);
  }

  /// Keeps the corners' colours, which are left out otherwise.
  void keepColors() { has_colors_ = true; }

  /// Begins the next model, of the next part.
  void model() {
    closeCluster();
    while (bounds_.size() % kBlockFloats != 0) padBounds();
    RenderModel next;
    next.part = static_cast<std::uint32_t>(models_.size());
    next.step = step_;
    next.first_cluster = static_cast<std::uint32_t>(clusters_.size());
    next.first_block = static_cast<std::uint32_t>(bounds_.size() / kBlockFloats);
    models_.push_back(next);
  }

  /// Counter-clockwise seen from outside.
  void triangle(const std::array<RenderVertex, 3>& corners, const RenderSurface& surface = {}) {
    std::array<Stored, 3> stored;
    std::size_t fresh = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      stored[n] = store(corners[n]);
      fresh += find(stored[n]) == open_.size() ? 1U : 0U;
    }
    if (open_.size() + fresh > kMostInCluster || open_triangles_.size() == kMostInCluster ||
        !(surface == open_surface_) || !fits(stored)) {
      closeCluster();
    }
    if (!fits(stored)) throw std::runtime_error("a triangle too large for the lattice's step");
    open_surface_ = surface;
    std::array<std::uint8_t, 3> numbers{};
    for (std::size_t n = 0; n < 3; ++n) {
      const std::size_t at = find(stored[n]);
      if (at == open_.size()) open_.push_back(stored[n]);
      numbers[n] = static_cast<std::uint8_t>(at);
    }
    open_triangles_.push_back(numbers);
  }

  /// Two triangles; corners counter-clockwise seen from outside, texture upright when they begin at
  /// the lower left one.
  void quad(const std::array<Vec3, 4>& corners, const RenderSurface& surface = {}) {
    constexpr std::array<float, 4> kU = {0, 1, 1, 0};
    constexpr std::array<float, 4> kV = {1, 1, 0, 0};
    const auto corner = [&](std::size_t n) { return RenderVertex{corners[n], kU[n], kV[n]}; };
    triangle({corner(0), corner(1), corner(2)}, surface);
    triangle({corner(0), corner(2), corner(3)}, surface);
  }

  void finish() { closeCluster(); }

  /// Valid while the builder lives.
  [[nodiscard]] RenderMeshes meshes() const {
    RenderMeshes meshes;
    meshes.models = models_;
    meshes.clusters = clusters_;
    // Blocks are stored lane by lane here, row by row there.
    meshes.cluster_bounds = bounds_rows_;
    meshes.vertices = vertices_;
    if (has_colors_) meshes.colors = colors_;
    meshes.triangles = triangles_;
    meshes.materials = materials_;
    for (const Texture& texture : textures_) {
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(texture.texels->data());
      meshes.textures.push_back(
          {"texture", texture.size, TexelFormat::kRgba8, {bytes, 4 * texture.texels->size()}});
    }
    meshes.semantics.assign(semantics_.begin(), semantics_.end());
    return meshes;
  }

  /// Where the renderer sees a point: the nearest one of the lattice.
  [[nodiscard]] Vec3 snapped(const Vec3& p) const {
    const auto at = [this](float v) { return static_cast<float>(std::lround(v / step_)) * step_; };
    return {at(p.x), at(p.y), at(p.z)};
  }

 private:
  struct Texture {
    std::uint32_t size;
    std::unique_ptr<std::vector<std::uint32_t>> texels;
  };
  struct Stored {
    std::array<std::int32_t, 3> lattice{};
    float u = 0;
    float v = 0;
    std::uint32_t color = 0;

    friend bool operator==(const Stored&, const Stored&) = default;
  };

  static constexpr std::size_t kBlockFloats = kBoundsRows * kRenderLanes;

  static std::vector<std::uint32_t> halved(std::uint32_t size,
                                           const std::vector<std::uint32_t>& texels) {
    std::vector<std::uint32_t> half;
    half.reserve(texels.size() / 4);
    for (std::uint32_t y = 0; y < size; y += 2) {
      for (std::uint32_t x = 0; x < size; x += 2) {
        std::uint32_t mixed = 0;
        for (std::uint32_t shift = 0; shift < 32; shift += 8) {
          std::uint32_t sum = 2;
          for (const std::uint32_t at :
               {y * size + x, y * size + x + 1, (y + 1) * size + x, (y + 1) * size + x + 1}) {
            sum += (texels[at] >> shift) & 0xFFU;
          }
          mixed |= sum / 4 << shift;
        }
        half.push_back(mixed);
      }
    }
    return half;
  }

  Stored store(const RenderVertex& vertex) const {
    const auto at = [this](float v) { return static_cast<std::int32_t>(std::lround(v / step_)); };
    const Vec3& p = vertex.position;
    return {{at(p.x), at(p.y), at(p.z)}, vertex.u, vertex.v, vertex.color};
  }

  std::size_t find(const Stored& vertex) const {
    return static_cast<std::size_t>(std::ranges::find(open_, vertex) - open_.begin());
  }

  /// Whether the open cluster's extent stays within 16 bits with these.
  bool fits(const std::array<Stored, 3>& more) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::int64_t low = more[0].lattice[axis];
      std::int64_t high = low;
      const auto extend = [&](const Stored& vertex) {
        low = std::min<std::int64_t>(low, vertex.lattice[axis]);
        high = std::max<std::int64_t>(high, vertex.lattice[axis]);
      };
      std::ranges::for_each(more, extend);
      std::ranges::for_each(open_, extend);
      if (high - low > 0xFFFF) return false;
    }
    return true;
  }

  void closeCluster() {
    if (open_triangles_.empty()) return;
    RenderCluster cluster;
    cluster.first_vertex = static_cast<std::uint32_t>(vertices_.size() / kVertexRows);
    cluster.first_triangle = static_cast<std::uint32_t>(triangles_.size() / kTriangleRows);
    cluster.vertex_count = static_cast<std::uint16_t>(open_.size());
    cluster.triangle_count = static_cast<std::uint16_t>(open_triangles_.size());
    cluster.material = open_surface_.material;
    cluster.semantic = open_surface_.semantic;
    cluster.two_sided = open_surface_.two_sided ? 1 : 0;
    std::array<std::int32_t, 3> low = open_[0].lattice;
    std::array<std::int32_t, 3> high = low;
    float u_high = cluster.u_minimum = open_[0].u;
    float v_high = cluster.v_minimum = open_[0].v;
    for (const Stored& vertex : open_) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], vertex.lattice[axis]);
        high[axis] = std::max(high[axis], vertex.lattice[axis]);
      }
      cluster.u_minimum = std::min(cluster.u_minimum, vertex.u);
      cluster.v_minimum = std::min(cluster.v_minimum, vertex.v);
      u_high = std::max(u_high, vertex.u);
      v_high = std::max(v_high, vertex.v);
    }
    cluster.origin_x = low[0];
    cluster.origin_y = low[1];
    cluster.origin_z = low[2];
    cluster.u_step = (u_high - cluster.u_minimum) / 65535;
    cluster.v_step = (v_high - cluster.v_minimum) / 65535;
    appendVertices(cluster);
    appendTriangles();
    appendBounds(low, high);
    ++models_.back().cluster_count;
    models_.back().triangles += cluster.triangle_count;
    clusters_.push_back(cluster);
    open_.clear();
    open_triangles_.clear();
  }

  void appendVertices(const RenderCluster& cluster) {
    const auto share = [](float value, float minimum, float step) {
      return step > 0 ? static_cast<std::uint16_t>(std::lround((value - minimum) / step))
                      : std::uint16_t{0};
    };
    const auto offset = [](std::int32_t value, std::int32_t origin) {
      return static_cast<std::uint16_t>(value - origin);
    };
    for (std::size_t first = 0; first < open_.size(); first += kRenderLanes) {
      std::array<std::uint16_t, kVertexRows * kRenderLanes> block{};
      for (std::size_t lane = 0; lane < kRenderLanes; ++lane) {
        const bool there = first + lane < open_.size();
        colors_.push_back(there ? open_[first + lane].color : 0);
        if (!there) continue;
        const Stored& vertex = open_[first + lane];
        block[lane] = offset(vertex.lattice[0], cluster.origin_x);
        block[kRenderLanes + lane] = offset(vertex.lattice[1], cluster.origin_y);
        block[2 * kRenderLanes + lane] = offset(vertex.lattice[2], cluster.origin_z);
        block[3 * kRenderLanes + lane] = share(vertex.u, cluster.u_minimum, cluster.u_step);
        block[4 * kRenderLanes + lane] = share(vertex.v, cluster.v_minimum, cluster.v_step);
      }
      vertices_.insert(vertices_.end(), block.begin(), block.end());
    }
  }

  void appendTriangles() {
    for (std::size_t first = 0; first < open_triangles_.size(); first += kRenderLanes) {
      std::array<std::uint8_t, kTriangleRows * kRenderLanes> block{};
      for (std::size_t lane = 0; lane < kRenderLanes; ++lane) {
        if (first + lane >= open_triangles_.size()) break;
        for (std::size_t corner = 0; corner < 3; ++corner) {
          block[corner * kRenderLanes + lane] = open_triangles_[first + lane][corner];
        }
      }
      triangles_.insert(triangles_.end(), block.begin(), block.end());
    }
  }

  void appendBounds(const std::array<std::int32_t, 3>& low,
                    const std::array<std::int32_t, 3>& high) {
    const auto at = [this](std::int32_t v) { return static_cast<float>(v) * step_; };
    const Vec3 least{at(low[0]), at(low[1]), at(low[2])};
    const Vec3 most{at(high[0]), at(high[1]), at(high[2])};
    const Vec3 centre = (least + most) * 0.5F;
    const Vec3 half = (most - least) * 0.50001F;
    const float radius = std::sqrt(dot(half, half));
    setBounds({centre.x, centre.y, centre.z, half.x, half.y, half.z, radius, 1, 0, 0, 2});
    RenderModel& model = models_.back();
    if (model.cluster_count == 0) {
      model.bounds_min = least;
      model.bounds_max = most;
      return;
    }
    model.bounds_min = {std::min(model.bounds_min.x, least.x),
                        std::min(model.bounds_min.y, least.y),
                        std::min(model.bounds_min.z, least.z)};
    model.bounds_max = {std::max(model.bounds_max.x, most.x), std::max(model.bounds_max.y, most.y),
                        std::max(model.bounds_max.z, most.z)};
  }

  void padBounds() { setBounds({0, 0, 0, -1e30F, -1e30F, -1e30F, -1e30F, 1, 0, 0, 2}); }

  /// The bounds of the next lane.
  void setBounds(const std::array<float, kBoundsRows>& values) {
    const std::size_t lane = bounds_.size() / kBoundsRows % kRenderLanes;
    if (lane == 0) {
      const std::size_t first = bounds_rows_.size();
      bounds_rows_.resize(first + kBlockFloats, 0);
      for (std::size_t row = 3; row < 7; ++row) {
        std::fill_n(bounds_rows_.begin() + static_cast<std::ptrdiff_t>(first + row * kRenderLanes),
                    kRenderLanes, -1e30F);
      }
    }
    const std::size_t block = bounds_.size() / kBlockFloats * kBlockFloats;
    for (std::size_t row = 0; row < kBoundsRows; ++row) {
      bounds_rows_[block + row * kRenderLanes + lane] = values[row];
      bounds_.push_back(values[row]);
    }
  }

  float step_;
  bool has_colors_ = false;
  std::vector<RenderModel> models_;
  std::vector<RenderCluster> clusters_;
  /// Eleven numbers per cluster or padding, and the same by rows of eight.
  std::vector<float> bounds_;
  std::vector<float> bounds_rows_;
  std::vector<std::uint16_t> vertices_;
  std::vector<std::uint32_t> colors_;
  std::vector<std::uint8_t> triangles_;
  std::vector<RenderMaterial> materials_;
  std::vector<Texture> textures_;
  std::vector<std::string> semantics_;
  std::vector<Stored> open_;
  std::vector<std::array<std::uint8_t, 3>> open_triangles_;
  RenderSurface open_surface_;
};

}  // namespace galactic::test
