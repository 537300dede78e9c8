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
#include "layout/render_pools.h"

namespace galactic::test {

/// A corner of a triangle: place in meters, texture coordinates with v down, color.
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
  /// `step`: meters between lattice points, a power of two.
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

  /// Keeps the corners' colors, which are left out otherwise.
  void keepColors() { has_colors_ = true; }

  /// Begins the next model, of the next part.
  void model() {
    closeModel();
    open_model_ = {.step = static_cast<double>(step_), .clusters = {}};
    has_model_ = true;
  }

  /// Counter-clockwise seen from outside.
  void triangle(const std::array<RenderVertex, 3>& corners, const RenderSurface& surface = {}) {
    std::array<LatticeVertex, 3> stored;
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

  void finish() { closeModel(); }

  /// Valid while the builder lives.
  [[nodiscard]] RenderMeshes meshes() const {
    RenderMeshes meshes = pools_.geometry();
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

  LatticeVertex store(const RenderVertex& vertex) const {
    const auto at = [this](float v) { return static_cast<std::int32_t>(std::lround(v / step_)); };
    const Vec3& p = vertex.position;
    return {{at(p.x), at(p.y), at(p.z)}, {vertex.u, vertex.v}, vertex.color};
  }

  std::size_t find(const LatticeVertex& wanted) const {
    const auto equal = [&](const LatticeVertex& vertex) {
      return vertex.at == wanted.at && vertex.uv == wanted.uv && vertex.color == wanted.color;
    };
    return static_cast<std::size_t>(std::ranges::find_if(open_, equal) - open_.begin());
  }

  /// Whether the open cluster's extent stays within 16 bits with these.
  bool fits(const std::array<LatticeVertex, 3>& more) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::int64_t low = more[0].at[axis];
      std::int64_t high = low;
      const auto extend = [&](const LatticeVertex& vertex) {
        low = std::min<std::int64_t>(low, vertex.at[axis]);
        high = std::max<std::int64_t>(high, vertex.at[axis]);
      };
      std::ranges::for_each(more, extend);
      std::ranges::for_each(open_, extend);
      if (high - low > kMostSteps) return false;
    }
    return true;
  }

  void closeCluster() {
    if (open_triangles_.empty()) return;
    open_model_.clusters.push_back({.vertices = std::move(open_),
                                    .triangles = std::move(open_triangles_),
                                    .material = open_surface_.material,
                                    .semantic = open_surface_.semantic,
                                    .two_sided = open_surface_.two_sided});
    open_.clear();
    open_triangles_.clear();
  }

  void closeModel() {
    if (!has_model_) return;
    closeCluster();
    appendModel(open_model_,
                {.part = static_cast<std::uint32_t>(pools_.models.size()), .colored = has_colors_},
                pools_);
    has_model_ = false;
  }

  float step_;
  bool has_colors_ = false;
  RenderPools pools_;
  std::vector<RenderMaterial> materials_;
  std::vector<Texture> textures_;
  std::vector<std::string> semantics_;
  LatticeModel open_model_;
  bool has_model_ = false;
  std::vector<LatticeVertex> open_;
  std::vector<std::array<std::uint8_t, 3>> open_triangles_;
  RenderSurface open_surface_;
};

}  // namespace galactic::test
