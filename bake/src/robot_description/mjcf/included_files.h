#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "robot_description/mjcf/xml_tree.h"

namespace galactic::bake {

/// An MJCF with the content of the files that it includes in the place of its <include> elements.
struct WholeMjcf {
  XmlElement root;
  std::vector<std::filesystem::path> included;
  /// Where one of them was looked for and is not.
  std::vector<std::filesystem::path> absent;
};

/// Most files that an MJCF may include.
inline constexpr std::size_t kMaxIncludedFiles = 200;

/// Parses the text of the MJCF at `path` and what it includes. Names of files are relative to the
/// including file's folder, or else to the folder of `path`; they may not lead out of the folder
/// above that one unless `allow_outside`. As in MuJoCo, no file is included twice, so there are no
/// circles. Fails with kIo (missing file) or kInvalidInput. For a process of its own.
[[nodiscard]] Result<WholeMjcf> parseWithIncluded(const std::string& text,
                                                  const std::filesystem::path& path,
                                                  bool allow_outside);

}  // namespace galactic::bake
