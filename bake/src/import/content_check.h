#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "galactic/error.h"

namespace galactic::bake {

/// Finds what the mesh readers handle badly, before they see the file: glTF extensions that they
/// would ignore (kUnsupported), and a PLY header without an end, on which they never return
/// (kInvalidInput). Formats go by the extension of `path`. Returns warnings: of images in formats
/// that are not read.
[[nodiscard]] Result<std::vector<std::string>> checkContent(const std::filesystem::path& path);

}  // namespace galactic::bake
