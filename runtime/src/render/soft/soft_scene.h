#pragma once
#include <cstdint>
#include <vector>

#include "galactic/render_library.h"
#include "render/raster/pane_task.h"

namespace galactic::render {

/// A library as the kernels read it: pointers into the packs' memory, and what has to be unpacked.
/// Immutable, so safe to share between threads; the library must outlive it. Not movable: its
/// tables point at each other.
class SoftScene {
 public:
  explicit SoftScene(const RenderLibrary& library);
  SoftScene(const SoftScene&) = delete;
  SoftScene& operator=(const SoftScene&) = delete;

  /// By the numbers of the library.
  [[nodiscard]] const std::vector<ModelTables>& models() const { return models_; }
  [[nodiscard]] const std::uint32_t* const* texelBases() const { return bases_.data(); }

 private:
  void addTextures(const RenderMeshes& meshes, std::vector<SurfaceTexels>& textures);
  void findBases(const std::vector<RenderMeshes>& packs);
  [[nodiscard]] SurfaceTexels inPlace(const RenderTexture& texture) const;
  void addModel(const RenderLibrary& library, std::uint32_t number);

  std::vector<std::vector<SurfaceTexels>> surfaces_;
  std::vector<std::vector<std::uint32_t>> color_kinds_;
  std::vector<PackTables> packs_;
  std::vector<ModelTables> models_;
  /// Texels that no pack has as they are drawn.
  std::vector<std::uint32_t> unpacked_;
  std::vector<const std::uint32_t*> bases_;
};

}  // namespace galactic::render
