#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "galactic/error.h"

namespace galactic {

static_assert(std::endian::native == std::endian::little, "packs are little-endian");

/// What a pack holds, as the four characters in its header.
enum class PackKind : std::uint32_t {
  kScene = 0x4e454353,     // "SCEN"
  kObjects = 0x534a424f,   // "OBJS"
  kRobot = 0x544f4252,     // "RBOT"
  kEpisodes = 0x53495045,  // "EPIS"
  kWorld = 0x444c5257,     // "WRLD"
  kTexture = 0x52545854,   // "TXTR"
  kPolicy = 0x59434c50,    // "PLCY"
};

/// The four characters of a kind, for messages.
[[nodiscard]] std::string packKindName(PackKind kind);

/// The kind that these four characters name; none if there is no such kind.
[[nodiscard]] std::optional<PackKind> packKindOf(std::string_view name);

inline constexpr std::array<char, 8> kPackMagic{'G', 'A', 'L', 'A', 'P', 'A', 'C', 'K'};
/// The format versions that this build reads; it writes the latest.
inline constexpr std::uint32_t kOldestPackVersion = 1;
inline constexpr std::uint32_t kLatestPackVersion = 1;

/// The first 64 bytes of each pack. The FlatBuffers payload follows at offset 64 and ends the file.
struct PackHeader {
  std::array<char, 8> magic = kPackMagic;
  std::uint32_t format_version = kLatestPackVersion;
  PackKind kind = PackKind::kScene;
  /// The file's size is exactly 64 + payload_bytes.
  std::uint64_t payload_bytes = 0;
  /// XXH64 of the payload, seed 0.
  std::uint64_t payload_xxh64 = 0;
  std::array<std::byte, 32> reserved{};
};
static_assert(sizeof(PackHeader) == 64);

/// The header of a payload of this kind.
[[nodiscard]] PackHeader makePackHeader(PackKind kind, std::span<const std::byte> payload);

/// Reads and checks the header at the start of `file`, the whole file's bytes: magic, version,
/// kind, size, reserved bytes. Does not read the payload. `where` names the file in errors.
[[nodiscard]] Result<PackHeader> readPackHeader(std::span<const std::byte> file,
                                                std::string_view where);

/// Compares the payload's hash with the header's. Reads the whole payload.
[[nodiscard]] Result<void> checkPackHash(const PackHeader& header,
                                         std::span<const std::byte> payload,
                                         std::string_view where);

}  // namespace galactic
