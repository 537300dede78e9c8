#pragma once
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace galactic::bake {

// Accessors to the parts of a glTF 2.0 file that nothing has validated: malformed parts count as
// absent.

/// Whether the file is a GLB, which has JSON and buffers in one file.
[[nodiscard]] bool isGlb(std::span<const std::byte> file);

/// The JSON of a glTF file: the whole file, or the first chunk of a GLB.
[[nodiscard]] std::span<const std::byte> gltfJson(std::span<const std::byte> file);

/// The part of a GLB after its JSON: a header of 8 bytes, then its own buffer. Empty for other
/// files.
[[nodiscard]] std::span<const std::byte> gltfBehindJson(std::span<const std::byte> file);

/// Sizes in bytes: of a GLB's header, and of the header before each chunk's content.
inline constexpr std::size_t kGlbHeader = 12;
inline constexpr std::size_t kGlbChunkHeader = 8;

/// The little-endian 32-bit number at `offset`, which must be in range.
[[nodiscard]] std::uint32_t gltfWordAt(std::span<const std::byte> bytes, std::size_t offset);

/// The document; not an object if the JSON is broken.
[[nodiscard]] nlohmann::json parseGltf(std::span<const std::byte> file);

/// The list with this key, or an empty list if there is none: files of glTF 1.0 have objects
/// instead.
[[nodiscard]] const nlohmann::json& gltfList(const nlohmann::json& document, const char* key);

/// The member as a whole number; none if it is absent or not a whole number.
[[nodiscard]] std::optional<std::uint64_t> gltfWhole(const nlohmann::json& object, const char* key);

/// The same, but `otherwise` if there is no such member.
[[nodiscard]] std::optional<std::uint64_t> gltfWhole(const nlohmann::json& object, const char* key,
                                                     std::uint64_t otherwise);

/// The member as a string; empty if it is absent or not a string.
[[nodiscard]] std::string gltfText(const nlohmann::json& object, const char* key);

/// Size in bytes of one component of an accessor (componentType); 0 for an unknown type.
[[nodiscard]] std::uint64_t gltfComponentBytes(std::uint64_t type);

}  // namespace galactic::bake
