#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "galactic/batch_renderer.h"
#include "render/gl/library_geometry.h"

namespace galactic::render::gl {

/// A placed model as one camera sees it (std430).
struct GpuInstance {
  /// Rows of camera_from_model: camera coordinate = dot(row, (p, 1)).
  std::array<std::array<float, 4>, 3> rows{};
  /// Factors that take z / x and y / x in the camera's frame to -1 to 1 across the image.
  float scale_x = 0;
  float scale_y = 0;
  std::uint32_t layer = 0;
  /// The semantic id of the whole instance, or kSemanticsOfPack.
  std::uint32_t semantic = 0;
};
static_assert(sizeof(GpuInstance) == 64);

/// Up to kChunkClusters neighboring clusters of an instance, all of one class (std430).
struct GpuChunk {
  std::uint32_t instance = 0;
  std::uint32_t first_cluster = 0;
  std::uint32_t count = 0;
};
static_assert(sizeof(GpuChunk) == 12);

/// How many items the views of a slice have.
struct SliceCounts {
  /// Without those that have nothing to show: empty models, transforms that are not finite.
  std::uint32_t instances = 0;
  std::uint64_t clusters = 0;
  /// By class: the chunks, and the most commands that they can need, which is if every other
  /// cluster is seen.
  std::array<std::uint32_t, kDrawClasses> chunks{};
  std::array<std::uint32_t, kDrawClasses> draws{};

  [[nodiscard]] std::uint32_t allChunks() const;
  [[nodiscard]] std::uint32_t allDraws() const;
};

[[nodiscard]] SliceCounts countSlice(std::span<const RenderView> views,
                                     std::span<const ModelClusters> models);

/// Where the lists of a slice are written, and what countSlice() counted for it.
struct SliceLists {
  SliceCounts counts;
  std::span<GpuInstance> instances;
  std::span<GpuChunk> chunks;
};

/// Writes the lists; chunks are sorted by class, view, instance and cluster. `aspect`: width of the
/// images divided by their height.
void listSlice(std::span<const RenderView> views, std::span<const ModelClusters> models,
               float aspect, const SliceLists& lists);

}  // namespace galactic::render::gl
