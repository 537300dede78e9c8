#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "galactic/error.h"
#include "galactic/render_meshes.h"
#include "view/glb_file.h"

namespace galactic {

/// Puts the models of one pack into a GLB file: unlit, with their textures as PNG images inside the
/// file. What vertex colors multiply is linear there and sRGB in a renderer's images, so products
/// differ a little.
class RenderGlbWriter {
 public:
  /// `meshes` and `file` outlive this.
  RenderGlbWriter(const RenderMeshes& meshes, GlbFile& file) : meshes_(meshes), file_(file) {}

  /// Adds a node for each semantic of a model under `parent`: called as the semantic; where the
  /// model has but one, `name`. Fails with kInternal when an image cannot be encoded.
  [[nodiscard]] Result<void> write(const RenderModel& model, const std::string& name,
                                   std::size_t parent);

 private:
  /// A material of the pack, and whether it is seen from both sides.
  using MaterialKey = std::pair<std::uint16_t, bool>;

  [[nodiscard]] Result<std::size_t> material(const MaterialKey& key);
  [[nodiscard]] Result<std::size_t> texture(std::size_t number);

  const RenderMeshes& meshes_;
  GlbFile& file_;
  std::map<MaterialKey, std::size_t> materials_;
  std::map<std::size_t, std::size_t> textures_;
};

}  // namespace galactic
