#pragma once
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace galactic::bake {

// What a glTF 2.0 file consists of, read with a stranger's eyes: whatever is not as it should be is
// as if it were not there.

/// Whether the file is a GLB: JSON and buffers in one.
[[nodiscard]] bool isGlb(std::span<const std::byte> file);

/// The JSON of a glTF file: the whole file, or the first chunk of a GLB.
[[nodiscard]] std::span<const std::byte> gltfJson(std::span<const std::byte> file);

/// What follows the JSON of a GLB: a header of 8 bytes, and its own buffer. Empty of other files.
[[nodiscard]] std::span<const std::byte> gltfBehindJson(std::span<const std::byte> file);

/// Bytes before the JSON of a GLB, and before what any chunk of it holds.
inline constexpr std::size_t kGlbHeader = 12;
inline constexpr std::size_t kGlbChunkHeader = 8;

/// The little-endian number of 32 bits at `offset`, which is there.
[[nodiscard]] std::uint32_t gltfWordAt(std::span<const std::byte> bytes, std::size_t offset);

/// The document; no object where the JSON is broken.
[[nodiscard]] nlohmann::json parseGltf(std::span<const std::byte> file);

/// An empty list where there is none: files of glTF 1.0 have objects instead.
[[nodiscard]] const nlohmann::json& gltfList(const nlohmann::json& document, const char* key);

/// The member as a whole number; none where it is absent or none.
[[nodiscard]] std::optional<std::uint64_t> gltfWhole(const nlohmann::json& object, const char* key);

/// The same, and `otherwise` where there is no such member.
[[nodiscard]] std::optional<std::uint64_t> gltfWhole(const nlohmann::json& object, const char* key,
                                                     std::uint64_t otherwise);

/// The member as a text; empty where it is absent or none.
[[nodiscard]] std::string gltfText(const nlohmann::json& object, const char* key);

/// Bytes of one component of an accessor (componentType); 0 of an unknown type.
[[nodiscard]] std::uint64_t gltfComponentBytes(std::uint64_t type);

}  // namespace galactic::bake
