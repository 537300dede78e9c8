#include "galactic/pack_header.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cstring>

namespace galactic {
namespace {

bool isKnownKind(PackKind kind) {
  switch (kind) {
    case PackKind::kScene:
    case PackKind::kObjects:
    case PackKind::kRobot:
    case PackKind::kEpisodes:
    case PackKind::kWorld:
    case PackKind::kTexture:
    case PackKind::kPolicy:
      return true;
  }
  return false;
}

}  // namespace

std::string packKindName(PackKind kind) {
  std::string name(4, ' ');
  std::memcpy(name.data(), &kind, name.size());
  return name;
}

std::optional<PackKind> packKindOf(std::string_view name) {
  PackKind kind{};
  if (name.size() != sizeof(kind)) return std::nullopt;
  std::memcpy(&kind, name.data(), sizeof(kind));
  if (!isKnownKind(kind)) return std::nullopt;
  return kind;
}

PackHeader makePackHeader(PackKind kind, std::span<const std::byte> payload) {
  PackHeader header;
  header.kind = kind;
  header.payload_bytes = payload.size();
  header.payload_xxh64 = XXH64(payload.data(), payload.size(), 0);
  return header;
}

Result<PackHeader> readPackHeader(std::span<const std::byte> file, std::string_view where) {
  const auto invalid = [&](std::string_view name, std::string message) {
    return fail(ErrorCode::kInvalidInput, std::string(where), std::move(message), name);
  };
  if (file.size() < sizeof(PackHeader)) {
    return invalid("pack/truncated",
                   fmt::format("has {} bytes, a pack has at least {}; it is truncated or no pack",
                               file.size(), sizeof(PackHeader)));
  }
  PackHeader header;
  std::memcpy(&header, file.data(), sizeof(PackHeader));
  if (header.magic != kPackMagic) {
    return invalid(
        "pack/not-a-pack",
        "does not begin with \"GALAPACK\": it is not a pack; bake one with galactic-bake");
  }
  if (header.format_version < kOldestPackVersion) {
    return fail(ErrorCode::kUnsupported, std::string(where),
                fmt::format("has format version {}, this program reads {} to {}; bake it again",
                            header.format_version, kOldestPackVersion, kLatestPackVersion),
                "pack/version-old");
  }
  if (header.format_version > kLatestPackVersion) {
    return fail(ErrorCode::kUnsupported, std::string(where),
                fmt::format("has format version {}, this program reads up to {}; update galactic",
                            header.format_version, kLatestPackVersion),
                "pack/version-new");
  }
  if (!isKnownKind(header.kind)) {
    return invalid("pack/kind", fmt::format("has the unknown kind 0x{:08x}; the file is damaged",
                                            static_cast<std::uint32_t>(header.kind)));
  }
  if (header.payload_bytes != file.size() - sizeof(PackHeader)) {
    return invalid("pack/size",
                   fmt::format("announces {} payload bytes but has {}; it is truncated or has "
                               "bytes too many, copy or bake it again",
                               header.payload_bytes, file.size() - sizeof(PackHeader)));
  }
  if (std::any_of(header.reserved.begin(), header.reserved.end(),
                  [](std::byte b) { return b != std::byte{0}; })) {
    return invalid("pack/reserved",
                   "has reserved header bytes that are not zero; the file is damaged");
  }
  return header;
}

Result<void> checkPackHash(const PackHeader& header, std::span<const std::byte> payload,
                           std::string_view where) {
  const std::uint64_t actual = XXH64(payload.data(), payload.size(), 0);
  if (actual == header.payload_xxh64) return {};
  return fail(ErrorCode::kInvalidInput, std::string(where),
              fmt::format("payload hash is {:016x}, the header says {:016x}; the file is damaged, "
                          "copy or bake it again",
                          actual, header.payload_xxh64),
              "pack/hash");
}

}  // namespace galactic
