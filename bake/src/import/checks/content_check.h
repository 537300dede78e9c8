#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/error.h"

namespace galactic::bake {

/// Finds what the mesh readers handle badly, before they see the file: glTF extensions that they
/// would ignore (kUnsupported), and files that hold less, or more, than they state, of which they
/// make up the rest (kInvalidInput; glTF, OBJ, PLY, STL, OFF; the readers of COLLADA and FBX see it
/// themselves). Formats go by the extension of `path`. Returns warnings: of images in formats that
/// are not read, and of a format of which nobody sees whether a file is whole.
[[nodiscard]] Result<std::vector<std::string>> checkContent(const std::filesystem::path& path);

/// Whether a glTF 2.0 file (.gltf or .glb, `bytes`) holds what it states: the chunks of a GLB its
/// length, buffers their bytes, buffer views their part of a buffer, accessors their elements, and
/// triangles three corners each. Buffers in files are looked for beside `path`. Fails with
/// kInvalidInput; what is no such file passes to the reader.
[[nodiscard]] Result<void> checkGltfRanges(const std::filesystem::path& path,
                                           std::span<const std::byte> bytes);

/// Whether a PLY file holds as many elements as its header states. Fails with kInvalidInput on a
/// header without an end or of more than 10,000 lines, on a file that ends before the last element,
/// and on one in which another element would fit behind it. What is no PLY passes: the reader says
/// so. `where` is for messages.
[[nodiscard]] Result<void> checkPlyCounts(std::string_view file, const std::string& where);

// Whether mesh files are whole, as far as they tell. Each fails with kInvalidInput; what it cannot
// judge passes to the reader. `where` is for messages.

/// An OBJ does not end inside a statement, its faces use vertices that it has, and it names at most
/// 1000 material files. A last line without an end is no offence if it can be whole: published
/// models have such.
[[nodiscard]] Result<void> checkObj(std::string_view file, const std::string& where);

/// A binary STL has the size of the triangles that it states; in one of text every solid, and every
/// facet of three vertices, is closed.
[[nodiscard]] Result<void> checkStl(std::string_view file, const std::string& where);

/// An OFF file has as many vertices and faces as it states.
[[nodiscard]] Result<void> checkOff(std::string_view file, const std::string& where);

/// What a glTF 2.0 file (JSON or GLB) wants of its reader: what it requires (`extensionsRequired`)
/// and the mesh reader ignores.
struct GltfRequirements {
  /// The first extension that changes shapes, such as Draco and meshopt compression.
  std::optional<std::string> unsupported;
  /// Whether its objects and lists are nested in more than 1000 levels, which no reader survives.
  bool is_too_deep = false;
  /// One sentence for each extension whose images cannot be read.
  std::vector<std::string> warnings;
};

/// Nothing also when `file` is no glTF: the reader then says why.
[[nodiscard]] GltfRequirements gltfRequirements(std::span<const std::byte> file);

}  // namespace galactic::bake
