#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Where a file may be that an asset names.
enum class Reach {
  kNear,      ///< Below the asset's folder; of textures below the folder above it.
  kAnywhere,  ///< Wherever it points.
};

/// Looks for files and folders, and remembers those that are not there: once they are, the same
/// search may end elsewhere.
class FileSearch {
 public:
  [[nodiscard]] bool findsFile(const std::filesystem::path& file);
  [[nodiscard]] bool findsFolder(const std::filesystem::path& folder);
  /// In the order of the search, some perhaps several times.
  [[nodiscard]] const std::vector<std::filesystem::path>& absent() const { return absent_; }

 private:
  std::vector<std::filesystem::path> absent_;
};

/// Whether Git LFS left a pointer in place of the file; false where it cannot be read.
[[nodiscard]] bool isLfsPointer(const std::filesystem::path& file);

/// `uri` with its escapes (%20) undone.
[[nodiscard]] std::string withoutUriEscapes(std::string_view uri);

/// `text` without blanks and line ends behind it: exporters leave some behind the names of files.
[[nodiscard]] std::string withoutTrailingBlanks(std::string_view text);

/// `file` as seen from the folder of `main_input`, with '/' between parts; never absolute.
[[nodiscard]] std::string nameRelativeTo(const std::filesystem::path& main_input,
                                         const std::filesystem::path& file);

/// Whether `file` lies in `folder` or below it, as the names say; links are not followed.
[[nodiscard]] bool isBelow(const std::filesystem::path& file, const std::filesystem::path& folder);

/// Looks for the textures that the materials name, relative to the folder of `main_input`: found
/// ones join `asset.read.files` and their materials get the path that was found; of missing ones
/// the materials get none, with one warning each, which joins `asset.missing`, too. Every place
/// where one is not joins `asset.read.absent`. Knows %20, backslashes, file:// and absolute paths
/// of another machine (then the file's name beside the main input counts, as it does for files out
/// of reach). Where the only texture that is named is missing, or an OBJ has no MTL, an image of
/// the mesh's own name, or "texture", takes its place, with a warning.
void findTextures(SourceAsset& asset, const std::filesystem::path& main_input, Reach reach);

/// Sorts `files`, main input first, leaves each once and fills in sizes and XXH3-128 hashes. Fails
/// with kIo when a file can no longer be read.
[[nodiscard]] Result<void> hashFiles(std::vector<SourceFile>& files,
                                     const std::filesystem::path& main_input);

}  // namespace galactic::bake
