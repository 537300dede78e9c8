#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"
#include "galactic/option_text.h"
#include "galactic/pack_header.h"

namespace galactic::bake {

/// One pack of a world, as the world's list describes it.
struct LinkedPack {
  /// Relative to the folder of the world pack, '/' between parts, no "." and no "..".
  std::string path;
  PackKind kind = PackKind::kScene;
  std::uint64_t bytes = 0;
  /// XXH3-128 of the file.
  std::uint64_t hash_low = 0;
  std::uint64_t hash_high = 0;

  friend bool operator==(const LinkedPack&, const LinkedPack&) = default;
};

/// Describes the packs in the files `paths`, given in any order, for a world pack in `folder`
/// (empty: the current one); returned by ascending path. Adds the packs of the textures that they
/// share, found with texturePackBeside() if they are not among `paths`. Opens and verifies all
/// packs and checks that they fit together. Fails with the errors of PackFile::open() and
/// checkTogether(), and with kInvalidInput if a file does not lie below `folder`, is listed twice
/// or is a world itself.
[[nodiscard]] Result<std::vector<LinkedPack>> linkPacks(
    std::span<const std::filesystem::path> paths, const std::filesystem::path& folder);

/// The bytes of a world pack's FlatBuffer, without the file header; packs by ascending path.
/// `task`: the world's task, as options of OptionScope::kTask in the order of the option table.
/// Fails with kInvalidInput if the list is not as schema/world.fbs requires: a path is empty,
/// absolute, leads upwards or is listed twice, or the list has a world, more than one robot or
/// episode set, or no scene.
[[nodiscard]] Result<std::vector<std::byte>> encodeWorldPack(std::vector<LinkedPack> packs,
                                                             const Provenance& provenance,
                                                             std::span<const OptionText> task = {});

/// Writes header and payload atomically; returns the file's size in bytes.
[[nodiscard]] Result<std::uint64_t> writeWorldPack(const std::filesystem::path& path,
                                                   std::vector<LinkedPack> packs,
                                                   const Provenance& provenance,
                                                   std::span<const OptionText> task = {});

}  // namespace galactic::bake
