#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "galactic/pack.h"
#include "pack_tool/figure/shared_textures_of.h"

namespace galactic::pack_tool {

/// A small picture of a page.
struct Thumbnail {
  std::string caption;
  int width = 0;
  int height = 0;
  /// A PNG file.
  std::string png;
};

/// Pictures of what is in `packs[number]`: each grid of a scene from above, and its meshes; each
/// object, a robot from four sides; of episodes their scenes from above, those of `packs` that are
/// nearest in it. None of other kinds. Notes the shared textures that were not found for them.
/// Fails as the pictures do.
[[nodiscard]] Result<std::vector<Thumbnail>> thumbnailsOf(std::span<const PackFile> packs,
                                                          std::size_t number,
                                                          AbsentTextures& absent);

}  // namespace galactic::pack_tool
