#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

#include "galactic/render_meshes.h"

namespace galactic {

// The one place that puts geometry into the layout of schema/render.fbs, both for baked packs and
// for render meshes made in memory.

/// Allocates with the alignment of packs, where vectors begin at multiples of 32 bytes.
template <class T>
struct PackAllocator {
  using value_type = T;
  static constexpr std::align_val_t kAlignment{32};

  PackAllocator() = default;
  template <class U>
  // NOLINTNEXTLINE(google-explicit-constructor): as the standard's allocators convert
  PackAllocator(const PackAllocator<U>&) noexcept {}

  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new(count * sizeof(T), kAlignment));
  }
  void deallocate(T* memory, std::size_t) noexcept { ::operator delete(memory, kAlignment); }
  friend bool operator==(const PackAllocator&, const PackAllocator&) { return true; }
};

/// Models and the pools that store them, as in a pack; see RenderMeshes.
struct RenderPools {
  template <class T>
  using Values = std::vector<T, PackAllocator<T>>;

  std::vector<RenderModel> models;
  Values<RenderCluster> clusters;
  Values<float> cluster_bounds;
  Values<std::uint16_t> vertices;
  /// One per vertex, or none.
  Values<std::uint32_t> colors;
  Values<std::uint8_t> triangles;

  /// Views of the models and pools, which this object must outlive; without materials, textures and
  /// semantics.
  [[nodiscard]] RenderMeshes geometry() const;
};

/// Finest step of a lattice, meters: finer than a float at the far end of a large scene.
inline constexpr double kFinestStep = 1.0 / 16384;
/// Most steps that a cluster may span along an axis.
inline constexpr std::int64_t kMostSteps = 65535;

/// A corner on the lattice of its model.
struct LatticeVertex {
  std::array<std::int32_t, 3> at{};
  /// v points down from the top of the image.
  std::array<float, 2> uv{};
  /// RGBA, sRGB, R lowest.
  std::uint32_t color = 0xFFFFFFFF;
};
static_assert(sizeof(LatticeVertex) == 24, "compared byte by byte, so without padding");

/// Triangles that are drawn or culled together.
struct LatticeCluster {
  /// 1 to kMostInCluster, at most kMostSteps apart along each axis.
  std::vector<LatticeVertex> vertices;
  /// 1 to kMostInCluster; corners are indices into vertices, counter-clockwise as seen from
  /// outside.
  std::vector<std::array<std::uint8_t, 3>> triangles;
  std::uint16_t material = 0;
  std::uint16_t semantic = 0;
  bool two_sided = false;
};

/// A model on its lattice.
struct LatticeModel {
  /// Meters: a power of two, at least kFinestStep.
  double step = 0;
  /// In the order in which they are stored.
  std::vector<LatticeCluster> clusters;
};

/// The values of a model beyond its clusters.
struct RenderModelFigures {
  std::uint32_t part = 0;
  std::uint32_t source_triangles = 0;
  float largest_error = 0;
  /// Whether vertices in the pools have colors: the same for all models.
  bool colored = false;
};

/// Appends a model to the pools. Bounds contain every corner as a renderer computes it, rounded
/// outward; one-sided clusters whose normals lie within 84 degrees of their mean get a cone.
/// Texture coordinates are stored relative to the whole image that contains the smallest one.
void appendModel(const LatticeModel& model, const RenderModelFigures& figures, RenderPools& pools);

}  // namespace galactic
