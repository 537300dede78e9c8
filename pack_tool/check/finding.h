#pragma once
#include <string>
#include <string_view>

#include "galactic/error.h"

namespace galactic::pack_tool {

/// The code of an error that opening or checking the pack `file` gave, which never changes: its
/// name, or, where a value in the pack offends, the path of the field in the schema without
/// indices: "scene/radii" for "kitchen.pack: scene.radii[1]". "pack/other" for an error with
/// neither, "internal/error" for errors of ours. docs/ci.md lists them.
[[nodiscard]] std::string findingCode(const Error& error, std::string_view file);

}  // namespace galactic::pack_tool
