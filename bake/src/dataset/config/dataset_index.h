#pragma once
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/config/template_list.h"
#include "galactic/error.h"

namespace galactic::bake {

/// What a dataset has templates of.
enum class TemplateKind : std::uint8_t { kStage, kObject, kArticulated, kScene };
inline constexpr std::size_t kTemplateKinds = 4;

/// How files and messages name a kind.
struct TemplateKindNames {
  /// The member of the dataset's configuration.
  const char* block;
  /// How the names of its attribute files end.
  std::string_view suffix;
  /// In a sentence.
  std::string_view noun;
};
[[nodiscard]] const TemplateKindNames& namesOf(TemplateKind kind);

/// Where templates were looked for: files with this ending in a folder (relative to the dataset's).
struct SearchedFolder {
  std::string folder;
  std::string ending;
};

/// One block of the dataset's configuration: all templates of a kind.
struct DatasetBlock {
  /// What all templates start from.
  std::optional<AttributeLayer> defaults;
  TemplateList templates;
  std::vector<SearchedFolder> searched;
};

/// What a dataset offers, by kind. Attribute files are named, not yet read.
struct DatasetIndex {
  /// The configuration and its folder, absolute.
  std::filesystem::path config;
  std::filesystem::path folder;
  std::array<DatasetBlock, kTemplateKinds> blocks;
  std::vector<std::string> warnings;
  /// Whether its files may lie anywhere.
  bool allow_outside = false;

  /// Refuses a file that is not below the folder above the dataset's, unless that is allowed. It is
  /// named at `where`.
  [[nodiscard]] Result<void> checkReach(const std::filesystem::path& file,
                                        const std::string& where) const;

  [[nodiscard]] const DatasetBlock& block(TemplateKind kind) const {
    return blocks[static_cast<std::size_t>(kind)];
  }
};

/// Reads the configuration of a dataset and looks for the files that its "paths" mean. Fails with
/// kIo or kInvalidInput.
[[nodiscard]] Result<DatasetIndex> readDatasetIndex(const std::filesystem::path& config,
                                                    bool allow_outside);

}  // namespace galactic::bake
