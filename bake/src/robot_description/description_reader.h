#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "galactic/error.h"
#include "robot_description/description.h"

namespace galactic::bake {

/// What is read of a robot's file, and what it may name.
struct DescriptionRequest {
  DescriptionPart part = DescriptionPart::kShapesAndJoints;
  /// Whether files that the text includes may lie anywhere: see RobotImportOptions.
  bool allow_outside = false;
};

/// Elements that nest deeper are refused.
inline constexpr int kMaxXmlNesting = 100;

/// Refuses, with kInvalidInput, what the XML parser must not see: no text, or one that is nested so
/// deep that the parser would exhaust the stack. `where` is put in front of errors.
[[nodiscard]] Result<void> checkRobotText(std::string_view text, const std::string& where);

/// The text of a robot's file, or of one that it includes, after checkRobotText. Fails with kIo,
/// and with kInvalidInput beyond kMaxRobotFileBytes.
[[nodiscard]] Result<std::string> readRobotText(const std::filesystem::path& path);

/// The name of the outermost element, found without a parser; empty where there is none.
[[nodiscard]] std::string_view rootElementOf(std::string_view text);

/// Parses URDF or MJCF text, told apart by the outermost element, after checkRobotText. For a
/// process of its own: broken XML may crash or hang the parser. `path` is put in front of errors;
/// what MJCF includes is read relative to it.
[[nodiscard]] Result<RobotDescription> parseDescription(const std::string& text,
                                                        const std::filesystem::path& path,
                                                        const DescriptionRequest& request);

}  // namespace galactic::bake
