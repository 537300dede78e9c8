#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "robot_description/mjcf/xml_tree.h"

namespace galactic::bake {

/// An MJCF in which the content of the included files replaces its <include> elements.
struct WholeMjcf {
  XmlElement root;
  std::vector<std::filesystem::path> included;
  /// Places where one of them was looked for in vain.
  std::vector<std::filesystem::path> absent;
};

/// The greatest number of files that an MJCF may include.
inline constexpr std::size_t kMaxIncludedFiles = 200;

/// Parses the text of the MJCF at `path` and the files that it includes. Names of files are
/// relative to the folder of the including file or else to that of `path`; without `allow_outside`,
/// they may not lead out of the folder above the latter. As in MuJoCo, no file may be included
/// twice, so there are no cycles. Fails with kIo (missing file) or kInvalidInput. Use it in a
/// process of its own.
[[nodiscard]] Result<WholeMjcf> parseWithIncluded(const std::string& text,
                                                  const std::filesystem::path& path,
                                                  bool allow_outside);

}  // namespace galactic::bake
