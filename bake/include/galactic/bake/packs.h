#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "galactic/bake/episode_set_import.h"
#include "galactic/bake/object_baker.h"
#include "galactic/bake/render_textures.h"
#include "galactic/bake/robot_baker.h"
#include "galactic/bake/scene_baker.h"
#include "galactic/bake/source_asset.h"
#include "galactic/error.h"

namespace galactic::bake {

// Writes what the bakers return as packs: for meshes and robots that a program has in memory.
// assets.h makes packs from files.

/// The bytes of a scene pack's FlatBuffer, without the file header. The same scene and provenance
/// give the same bytes. Fails with kUnsupported if the pack would reach 2 GiB, the limit of one
/// pack.
[[nodiscard]] Result<std::vector<std::byte>> encodeScenePack(const BakedScene& scene,
                                                             const Provenance& provenance);

/// Writes header and payload atomically; returns the file's size in bytes.
[[nodiscard]] Result<std::uint64_t> writeScenePack(const std::filesystem::path& path,
                                                   const BakedScene& scene,
                                                   const Provenance& provenance);

/// The objects of one pack, as they were baked.
struct BakedObjectSet {
  /// Working set, meters, ascending.
  std::vector<float> radii;
  std::vector<BakedObject> objects;
};

/// The bytes of an object pack's FlatBuffer, without the file header; objects by ascending name.
/// The same objects and provenance give the same bytes. Fails with kInvalidInput if there is no
/// object, if one has no name or if two have the same name, and with kUnsupported if the pack would
/// reach 2 GiB, the limit of one pack.
[[nodiscard]] Result<std::vector<std::byte>> encodeObjectPack(const BakedObjectSet& set,
                                                              const Provenance& provenance);

/// Writes header and payload atomically; returns the file's size in bytes.
[[nodiscard]] Result<std::uint64_t> writeObjectPack(const std::filesystem::path& path,
                                                    const BakedObjectSet& set,
                                                    const Provenance& provenance);

/// The bytes of a robot pack's FlatBuffer, without the file header. The same robot and provenance
/// give the same bytes. Fails with kUnsupported if the pack would reach 2 GiB, the limit of one
/// pack.
[[nodiscard]] Result<std::vector<std::byte>> encodeRobotPack(const BakedRobot& robot,
                                                             const Provenance& provenance);

/// Writes header and payload atomically; returns the file's size in bytes.
[[nodiscard]] Result<std::uint64_t> writeRobotPack(const std::filesystem::path& path,
                                                   const BakedRobot& robot,
                                                   const Provenance& provenance);

/// The bytes of a texture pack's FlatBuffer, without the file header: `texture` of `materials`.
[[nodiscard]] std::vector<std::byte> encodeTexturePack(const BakedMaterials& materials,
                                                       const BakedTexture& texture,
                                                       const Provenance& provenance);

/// Writes header and payload atomically; returns the file's size in bytes.
[[nodiscard]] Result<std::uint64_t> writeTexturePack(const std::filesystem::path& path,
                                                     const BakedMaterials& materials,
                                                     const BakedTexture& texture,
                                                     const Provenance& provenance);

/// The bytes of an episode pack's FlatBuffer, without the file header. The same episodes and
/// provenance give the same bytes. The components of rotations are rounded to multiples of 2^-48,
/// which changes only those below 2^-25 (3e-8), so that exports can write them and read them back
/// exactly. Fails with kInvalidInput if the episodes are not as schema/episodes.fbs requires (names
/// that are empty or out of order, indices or ranges out of bounds, placements that are not in the
/// order of the episodes or belong to none of them, counts that do not agree, numbers that are not
/// finite, rotations that are not of length 1); `where` names the element. Fails with kUnsupported
/// if the pack would reach 2 GiB, the limit of one pack.
[[nodiscard]] Result<std::vector<std::byte>> encodeEpisodePack(const SourceEpisodes& episodes,
                                                               const Provenance& provenance);

/// Writes header and payload atomically; returns the file's size in bytes.
[[nodiscard]] Result<std::uint64_t> writeEpisodePack(const std::filesystem::path& path,
                                                     const SourceEpisodes& episodes,
                                                     const Provenance& provenance);

}  // namespace galactic::bake
