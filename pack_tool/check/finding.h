#pragma once
#include <span>
#include <string>
#include <string_view>

#include "galactic/error.h"

namespace galactic::pack_tool {

/// A kind of offence that concerns a file or a world as a whole.
struct FindingKind {
  /// Stable: it is never given to anything else. "area/what".
  std::string_view code;
  ErrorCode error = ErrorCode::kInvalidInput;
  /// A part of the error's message that no other kind has before it in the table.
  std::string_view fragment;
};

/// All of them, as docs/ci.md lists them.
[[nodiscard]] std::span<const FindingKind> findingKinds();

/// The code of an error that opening or checking the pack `file` gave: that of its kind, or, where
/// a value in the pack offends, the path of the field in the schema without indices: "scene/radii"
/// for "kitchen.pack: scene.radii[1]". "pack/other" where the table lacks the kind,
/// "internal/error" for errors of ours.
[[nodiscard]] std::string findingCode(const Error& error, std::string_view file);

}  // namespace galactic::pack_tool
