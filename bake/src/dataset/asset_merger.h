#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Puts assets together into one: each asset's meshes, materials and images once, however often
/// they are placed. Paths become relative to the folder of `main_input`.
class AssetMerger {
 public:
  AssetMerger(std::filesystem::path main_input, SourceAsset& into)
      : main_input_(std::move(main_input)), into_(into) {}

  /// Takes over `asset`, whose textures are relative to `folder`, unless `key` was taken over
  /// before. With `color` (linear RGBA), the meshes that say nothing of their looks have it.
  /// Returns the index of its first mesh.
  std::uint32_t take(const std::string& key, const SourceAsset& asset,
                     const std::filesystem::path& folder,
                     const std::optional<std::array<float, 4>>& color = std::nullopt);

  /// Places all instances of `asset`, whose first mesh is `first_mesh`.
  void place(std::uint32_t first_mesh, const SourceAsset& asset, const Affine& world_from_asset,
             const std::string& name);

  /// Notes that a file was read; `file` has size and hash, and `path` says which it is.
  void noteFile(const std::filesystem::path& path, SourceFile file);
  /// Reads the file for that.
  [[nodiscard]] Result<void> noteFile(const std::filesystem::path& path);
  /// Sorts the files.
  void finish();

 private:
  void takeMaterials(const SourceAsset& asset, const std::filesystem::path& folder);

  std::filesystem::path main_input_;
  SourceAsset& into_;
  std::map<std::string, std::uint32_t> first_meshes_;
  std::map<std::string, SourceFile> files_;
};

}  // namespace galactic::bake
