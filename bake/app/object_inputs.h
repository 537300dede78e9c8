#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "galactic/error.h"

namespace galactic::bake {

/// One mesh file that becomes an object.
struct ObjectInput {
  std::filesystem::path path;
  /// Name of the object in the pack.
  std::string name;
};

/// The objects that `inputs` (mesh files, and folders that are searched) name, by ascending name.
/// A file is an object named by its stem. In a folder below an input, a file whose stem is
/// "textured" or "model" stands for the whole folder and takes its name: so are YCB and Google
/// Scanned Objects laid out. Fails with kIo where a folder cannot be read, and with kInvalidInput
/// where one holds no mesh or two objects have one name.
[[nodiscard]] Result<std::vector<ObjectInput>> findObjects(
    const std::vector<std::filesystem::path>& inputs);

}  // namespace galactic::bake
