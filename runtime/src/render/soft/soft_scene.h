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

/// Most bytes from a base to the end of its texels: what the kernels can address, and more than any
/// texture has.
inline constexpr std::size_t kMostTexelBytes = 0x7FFFFFFF;

/// A library as the kernels read it: pointers into the packs' memory, and unpacked copies where the
/// kernels need another format. Immutable, so safe to share between threads; the library must
/// outlive it. Not movable, because its tables point at each other.
class SoftScene {
 public:
  /// `most_bytes`: always kMostTexelBytes, except in tests.
  explicit SoftScene(const RenderLibrary& library, std::size_t most_bytes = kMostTexelBytes);
  SoftScene(const SoftScene&) = delete;
  SoftScene& operator=(const SoftScene&) = delete;

  /// In the order of the library's models.
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
  /// First the bases in the packs' memory, then one for each of `unpacked_`.
  std::vector<const std::uint32_t*> bases_;
  std::size_t bases_in_packs_ = 0;
  /// Texels that the packs have in another format than the kernels read.
  std::vector<std::vector<std::uint32_t>> unpacked_;
  /// Only looked up, never iterated, so the order of addresses does not matter.
  std::map<TextureKey, SurfaceTexels> known_;
};

}  // namespace galactic::render
