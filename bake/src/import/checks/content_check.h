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

/// Finds what the mesh readers handle badly, before they see the file. Fails with kUnsupported on
/// glTF extensions that they would ignore, and with kInvalidInput on files that hold less than they
/// state, where readers would make up the rest, or more (glTF, OBJ, PLY, STL and OFF; the readers
/// of COLLADA and FBX notice it themselves). Takes the format from the extension of `path`. Returns
/// warnings: of images in formats that cannot be read, and of a format for which there is no check
/// that a file is complete.
[[nodiscard]] Result<std::vector<std::string>> checkContent(const std::filesystem::path& path);

/// Checks that a glTF 2.0 file (.gltf or .glb, `bytes`) holds what it states: a GLB its chunks,
/// buffers their bytes, buffer views their part of a buffer, accessors their elements, and
/// triangles three corners each. Looks for buffers in files beside `path`. Fails with
/// kInvalidInput; passes anything that is not such a file, as the reader will refuse it.
[[nodiscard]] Result<void> checkGltfRanges(const std::filesystem::path& path,
                                           std::span<const std::byte> bytes);

/// Checks that a PLY file holds as many elements as its header states. Fails with kInvalidInput if
/// the header has no end or more than 10,000 lines, if the file ends before the last element, or if
/// another element would fit after it. Passes what is not a PLY, as the reader reports it. `where`
/// is for messages.
[[nodiscard]] Result<void> checkPlyCounts(std::string_view file, const std::string& where);

// Checks that mesh files are complete, as far as their content shows. Each fails with
// kInvalidInput, and passes what it cannot judge on to the reader. `where` is for messages.

/// Checks that an OBJ does not end inside a statement, that its faces use vertices that exist, and
/// that it names at most 1000 material files. A last line without a line end passes if it can be
/// complete: there are published models with one.
[[nodiscard]] Result<void> checkObj(std::string_view file, const std::string& where);

/// Checks that a binary STL is as long as its number of triangles requires; in a text STL, that
/// every solid is closed, and so is every facet, which has three vertices.
[[nodiscard]] Result<void> checkStl(std::string_view file, const std::string& where);

/// Checks that an OFF file has as many vertices and faces as it states.
[[nodiscard]] Result<void> checkOff(std::string_view file, const std::string& where);

/// What a glTF 2.0 file (JSON or GLB) requires (`extensionsRequired`) but the mesh reader ignores.
struct GltfRequirements {
  /// The first extension that changes shapes, such as Draco and meshopt compression.
  std::optional<std::string> unsupported;
  /// Whether its objects and lists are nested in more than 1000 levels, which no reader survives.
  bool is_too_deep = false;
  /// One sentence for each extension whose images cannot be read.
  std::vector<std::string> warnings;
};

/// Empty also if `file` is not a glTF: the reader then reports why.
[[nodiscard]] GltfRequirements gltfRequirements(std::span<const std::byte> file);

}  // namespace galactic::bake
