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

/// What is there now of the files that one scene, object or robot is baked from.
struct AssetSources {
  PackKind kind = PackKind::kScene;
  /// In its pack.
  std::string_view name;
  /// By their names relative to the folder of the main input, as importers name them.
  std::vector<bake::SourceFile> files;
  /// What the job names besides, such as a robot's recipe: by their own names. Empty paths are
  /// none.
  std::vector<std::filesystem::path> named{};
};

/// What the packs of a world say that they were baked from. Immutable.
class PackSources {
 public:
  explicit PackSources(const World& world);

  /// What the pack lists of an asset's own files, named as AssetSources::files are.
  [[nodiscard]] std::vector<bake::SourceFile> listed(PackKind kind, std::string_view name) const;

  /// One sentence for each file whose content is not what the asset's pack was baked from, or that
  /// this does not list; a file that has moved, whose content it lists, is the same. None where the
  /// pack does not say what it was baked from. Fails with kIo where a file of `now.named` cannot be
  /// read.
  [[nodiscard]] Result<std::vector<std::string>> differences(const AssetSources& now) const;

 private:
  /// The sources of the pack that holds the asset; null where none does.
  [[nodiscard]] const std::vector<bake::SourceFile>* of(PackKind kind, std::string_view name) const;

  /// Of each pack.
  std::vector<std::vector<bake::SourceFile>> sources_;
  /// Index of the pack that holds an asset.
  std::map<std::pair<PackKind, std::string>, std::size_t> pack_of_;
};

/// A hash of the files whose content `log` tells, by their paths, in hexadecimal digits. What was
/// looked for in vain does not count: once it is there, it is read.
[[nodiscard]] std::string digestOf(const bake::ReadLog& log);

}  // namespace galactic::dynamics
