#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "galactic/error.h"
#include "robot_description/description.h"

namespace galactic::bake {

/// The part of a robot's file to read, and where files that it names may be.
struct DescriptionRequest {
  DescriptionPart part = DescriptionPart::kShapesAndJoints;
  /// Whether files that the text includes may be anywhere; see RobotImportOptions.
  bool allow_outside = false;
};

/// Deeper nesting of elements is refused.
inline constexpr int kMaxXmlNesting = 100;

/// Refuses, with kInvalidInput, text that the XML parser must not see: empty, or nested so deep
/// that the parser would exhaust the stack. Errors begin with `where`.
[[nodiscard]] Result<void> checkRobotText(std::string_view text, const std::string& where);

/// Reads the text of a robot's file, or of one that it includes, and passes it through
/// checkRobotText. Fails with kIo, and with kInvalidInput beyond kMaxRobotFileBytes.
[[nodiscard]] Result<std::string> readRobotText(const std::filesystem::path& path);

/// The name of the outermost element, found without a parser; empty if there is none.
[[nodiscard]] std::string_view rootElementOf(std::string_view text);

/// Parses URDF or MJCF text, depending on the outermost element, after checkRobotText. Use it in a
/// process of its own: broken XML may crash or hang the parser. Errors begin with `path`; files
/// that an MJCF includes are relative to it.
[[nodiscard]] Result<RobotDescription> parseDescription(const std::string& text,
                                                        const std::filesystem::path& path,
                                                        const DescriptionRequest& request);

}  // namespace galactic::bake
