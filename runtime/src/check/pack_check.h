#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "galactic/error.h"
#include "galactic/pack_header.h"

namespace galactic::detail {

/// Most bytes of a pack's payload: FlatBuffers counts in 31 bits.
inline constexpr std::uint64_t kMaxPayloadBytes = (std::uint64_t{1} << 31U) - 1;

/// Checks that the payload can be one of our FlatBuffers at all: its size and its file identifier.
[[nodiscard]] Result<void> checkPayloadStart(std::span<const std::byte> payload,
                                             const std::string& where);

/// Checks the structure (FlatBuffers verifier) and the meaning (every value) of the pack in `file`,
/// whose header has been read and whose payload has passed checkPayloadStart(). A scene pack that
/// passes is safe to query with any input. Fails with kInvalidInput.
[[nodiscard]] Result<void> checkPack(const PackHeader& header, std::span<const std::byte> file,
                                     const std::string& where);

}  // namespace galactic::detail
