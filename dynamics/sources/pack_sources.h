#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "galactic/bake/assets.h"
#include "galactic/bake/read_files.h"
#include "galactic/pack_header.h"
#include "galactic/world.h"

namespace galactic::dynamics {

/// The present files from which one scene, object or robot is baked.
struct AssetSources {
  PackKind kind = PackKind::kScene;
  /// The name in its pack.
  std::string_view name;
  /// Named relative to the folder of the main input, as importers do.
  std::vector<bake::SourceFile> files;
  /// Other files that the job names, such as a robot's recipe, under their own names. Empty paths
  /// are ignored.
  std::vector<std::filesystem::path> named{};
};

/// The source files that the packs of a world list. Immutable.
class PackSources {
 public:
  explicit PackSources(const World& world);

  /// The asset's own files as listed in its pack, named as in AssetSources::files.
  [[nodiscard]] std::vector<bake::SourceFile> listed(PackKind kind, std::string_view name) const;

  /// One sentence for each file whose content differs from that in the asset's pack, or that the
  /// pack does not list. A file that was moved is the same if its content is listed. Empty if the
  /// pack does not list its sources. Fails with kIo if a file in `now.named` cannot be read.
  [[nodiscard]] Result<std::vector<std::string>> differences(const AssetSources& now) const;

 private:
  /// The sources of the pack that holds the asset; null if no pack does.
  [[nodiscard]] const std::vector<bake::SourceFile>* of(PackKind kind, std::string_view name) const;

  /// By pack.
  std::vector<std::vector<bake::SourceFile>> sources_;
  /// Index of the pack that holds an asset.
  std::map<std::pair<PackKind, std::string>, std::size_t> pack_of_;
};

/// A hash, in hexadecimal digits, of paths and contents of the files in `log` that have a content.
/// Files that were looked for but not found do not count: if one appears, it will be read.
[[nodiscard]] std::string digestOf(const bake::ReadLog& log);

}  // namespace galactic::dynamics
