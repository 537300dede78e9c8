#pragma once
#include <span>
#include <string>

#include "galactic/error.h"
#include "pack_tool/figure/figure.h"

namespace galactic::pack_tool {

/// Figures as a GLB file (glTF 2.0, meters, Y up). Every figure and part is a named node, parts
/// under those that carry them; under a part lie "NAME mesh" with its materials and textures (or
/// vertex colors, without render meshes; a scene has a node for each semantic instead), "NAME
/// spheres" with a node for each sphere, which share one mesh for each radius, and "NAME box" as
/// lines. A robot has nodes "grasp point" and "camera", the latter a camera of glTF. Fails with
/// kUnsupported, an empty `where`, when the file would be larger than 4 GiB, and with kInternal
/// when an image cannot be encoded.
[[nodiscard]] Result<std::string> encodeGlb(std::span<const Figure> figures);

}  // namespace galactic::pack_tool
