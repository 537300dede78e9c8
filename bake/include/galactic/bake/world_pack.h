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

/// Describes the packs in the files `paths`, in any order, for a world pack in `folder` (empty: the
/// current one); ascending paths. Adds the packs of the textures that they share, found with
/// texturePackBeside where they are not among `paths`. Opens and verifies all and sees that they
/// fit together: fails with the errors of PackFile::open and checkTogether, and with kInvalidInput
/// when a file does not lie below `folder`, is listed twice or is a world itself.
[[nodiscard]] Result<std::vector<LinkedPack>> linkPacks(
    std::span<const std::filesystem::path> paths, const std::filesystem::path& folder);

/// The bytes of a world pack's FlatBuffer, without the file header; packs by ascending path.
/// `task`: what the world says of its task, options of OptionScope::kTask in the order of the
/// option table. Fails with kInvalidInput when the list is not as schema/world.fbs wants it: a path
/// that is empty, absolute, leads upwards or is there twice, a world, more than one robot or
/// episode set, no scene.
[[nodiscard]] Result<std::vector<std::byte>> encodeWorldPack(std::vector<LinkedPack> packs,
                                                             const Provenance& provenance,
                                                             std::span<const OptionText> task = {});

/// Writes header and payload atomically; returns the file's size in bytes.
[[nodiscard]] Result<std::uint64_t> writeWorldPack(const std::filesystem::path& path,
                                                   std::vector<LinkedPack> packs,
                                                   const Provenance& provenance,
                                                   std::span<const OptionText> task = {});

}  // namespace galactic::bake
