#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "galactic/error.h"

namespace galactic::bake {

/// Finds what the mesh readers handle badly, before they see the file: glTF extensions that they
/// would ignore (kUnsupported), and files that hold less, or more, than they state, of which they
/// make up the rest (kInvalidInput; glTF, OBJ, PLY, STL, OFF; the readers of COLLADA and FBX see it
/// themselves). Formats go by the extension of `path`. Returns warnings: of images in formats that
/// are not read, and of a format of which nobody sees whether a file is whole.
[[nodiscard]] Result<std::vector<std::string>> checkContent(const std::filesystem::path& path);

}  // namespace galactic::bake
