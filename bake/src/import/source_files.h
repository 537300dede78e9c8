#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Where the files that an asset names may be.
enum class Reach {
  kNear,      ///< Below the asset's folder; textures also below its parent folder.
  kAnywhere,  ///< Wherever it points.
};

/// Looks for files and folders and records those that do not exist: if they appear later, the same
/// search may find something else.
class FileSearch {
 public:
  [[nodiscard]] bool findsFile(const std::filesystem::path& file);
  [[nodiscard]] bool findsFolder(const std::filesystem::path& folder);
  /// In the order of the search; may contain repetitions.
  [[nodiscard]] const std::vector<std::filesystem::path>& absent() const { return absent_; }

 private:
  std::vector<std::filesystem::path> absent_;
};

/// Whether `file` is a Git LFS pointer instead of the content; false if it cannot be read.
[[nodiscard]] bool isLfsPointer(const std::filesystem::path& file);

/// `uri` with its escapes (%20) decoded.
[[nodiscard]] std::string withoutUriEscapes(std::string_view uri);

/// `text` without trailing blanks and line ends, which some exporters leave after file names.
[[nodiscard]] std::string withoutTrailingBlanks(std::string_view text);

/// The path of `file` relative to the folder of `main_input`, with '/' as the separator; never
/// absolute.
[[nodiscard]] std::string nameRelativeTo(const std::filesystem::path& main_input,
                                         const std::filesystem::path& file);

/// Whether `file` lies in `folder` or below it, judged by the paths alone; does not follow links.
[[nodiscard]] bool isBelow(const std::filesystem::path& file, const std::filesystem::path& folder);

/// Looks for the textures that the materials name, relative to the folder of `main_input`. Adds
/// those it finds to `asset.read.files` and sets the path in their materials. Removes missing ones
/// from their materials, and adds one sentence about each to the warnings and to `asset.missing`.
/// Adds every place where it looked in vain to `asset.read.absent`.
/// Understands %20, backslashes, file:// and absolute paths of another machine; for the latter, and
/// for files out of reach, it looks for a file of the same name beside the main input. If the only
/// texture that is named is missing, or an OBJ has no MTL, an image named like the mesh, or
/// "texture", takes its place, with a warning.
void findTextures(SourceAsset& asset, const std::filesystem::path& main_input, Reach reach);

/// Sorts `files`, main input first, removes duplicates, and fills in sizes and XXH3-128 hashes.
/// Fails with kIo if a file can no longer be read.
[[nodiscard]] Result<void> hashFiles(std::vector<SourceFile>& files,
                                     const std::filesystem::path& main_input);

}  // namespace galactic::bake
