#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "galactic/bake/provenance.h"
#include "galactic/bake/source_episodes.h"
#include "galactic/error.h"

namespace galactic::bake {

/// The bytes of an episode pack's FlatBuffer, without the file header. The same episodes and
/// provenance give the same bytes. Fails with kInvalidInput when the episodes are not as
/// schema/episodes.fbs wants them (names empty or out of order, indices or ranges out of bounds,
/// placements in another order than the episodes or of none of them, counts that do not agree,
/// numbers that are not finite, rotations not of length 1); `where` names the element. Fails with
/// kUnsupported when the pack would reach 2 GiB, the limit of one pack.
[[nodiscard]] Result<std::vector<std::byte>> encodeEpisodePack(const SourceEpisodes& episodes,
                                                               const Provenance& provenance);

/// Writes header and payload atomically; returns the file's size in bytes.
[[nodiscard]] Result<std::uint64_t> writeEpisodePack(const std::filesystem::path& path,
                                                     const SourceEpisodes& episodes,
                                                     const Provenance& provenance);

}  // namespace galactic::bake
