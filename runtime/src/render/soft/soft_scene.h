#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "galactic/render_library.h"
#include "render/raster/pane_task.h"
#include "render/raster/tables.h"

namespace galactic::render {

/// From a base to the last byte of its texels: what the kernels' numbers of texels can tell, and
/// more than any texture has.
inline constexpr std::size_t kMostTexelBytes = 0x7FFFFFFF;

/// A library as the kernels read it: pointers into the packs' memory, and what has to be unpacked.
/// Immutable, so safe to share between threads; the library must outlive it. Not movable: its
/// tables point at each other.
class SoftScene {
 public:
  /// `most_bytes`: kMostTexelBytes, but for tests.
  explicit SoftScene(const RenderLibrary& library, std::size_t most_bytes = kMostTexelBytes);
  SoftScene(const SoftScene&) = delete;
  SoftScene& operator=(const SoftScene&) = delete;

  /// By the numbers of the library.
  [[nodiscard]] const std::vector<ModelTables>& models() const { return models_; }
  [[nodiscard]] const std::uint32_t* const* texelBases() const { return bases_.data(); }

 private:
  void addTextures(const RenderMeshes& meshes, std::vector<SurfaceTexels>& textures);
  void findBases(const std::vector<RenderMeshes>& packs);
  [[nodiscard]] bool reaches(const std::uint32_t* base, std::span<const std::uint8_t> texels) const;
  [[nodiscard]] SurfaceTexels inPlace(const RenderTexture& texture) const;
  SurfaceTexels unpacked(const RenderTexture& texture);
  void addModel(const RenderLibrary& library, std::uint32_t number);

  std::vector<std::vector<SurfaceTexels>> surfaces_;
  std::vector<std::vector<std::uint32_t>> color_kinds_;
  std::vector<PackTables> packs_;
  std::vector<ModelTables> models_;
  std::size_t most_bytes_;
  /// First those in the packs' memory, then one for each of `unpacked_`.
  std::vector<const std::uint32_t*> bases_;
  std::size_t bases_in_packs_ = 0;
  /// Texels that no pack has as they are drawn.
  std::vector<std::vector<std::uint32_t>> unpacked_;
  /// Asked, never walked through.
  std::map<TextureKey, SurfaceTexels> known_;
};

}  // namespace galactic::render
