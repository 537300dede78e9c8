#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "view/json_writer.h"

namespace galactic {

/// What an array of a chunk holds: little-endian, as the page's data.js reads it.
enum class ChunkType : std::uint8_t { kU8, kU16, kU32, kI32, kF32 };

/// Arrays that a page unpacks together, when it first needs one of them.
class Chunk {
 public:
  /// Bytes as they are.
  void add(std::string_view name, std::span<const std::uint8_t> values);
  void add(std::string_view name, std::span<const float> values);
  void add(std::string_view name, std::span<const std::uint32_t> values);
  /// All first bytes of the numbers, then all second ones: what is near to each other is alike, so
  /// that it compresses better.
  void addPlanes(std::string_view name, std::span<const std::uint16_t> values);
  void addPlanes(std::string_view name, std::span<const std::int32_t> values);

  struct Array {
    std::string name;
    ChunkType type = ChunkType::kU8;
    bool is_planes = false;
    std::size_t at = 0;
    std::size_t count = 0;
  };
  [[nodiscard]] const std::vector<Array>& arrays() const { return arrays_; }
  [[nodiscard]] std::string_view bytes() const { return bytes_; }

 private:
  void append(Array array, std::span<const std::byte> bytes);

  std::vector<Array> arrays_;
  std::string bytes_;
};

/// The chunks of a page, compressed.
class PageData {
 public:
  /// Keeps a chunk and writes where it is: {"chunk": number, "bytes": unpacked, "arrays": [[name,
  /// type, offset, count], ...]}.
  void add(JsonWriter& json, std::string_view key, const Chunk& chunk);

  /// Each as zlib wraps it (RFC 1950), in base64.
  [[nodiscard]] const std::vector<std::string>& chunks() const { return chunks_; }

 private:
  std::vector<std::string> chunks_;
};

[[nodiscard]] std::string base64(std::string_view bytes);

/// `bytes` as zlib compresses them (RFC 1950), in base64: no character in it means anything to
/// HTML.
[[nodiscard]] std::string packedText(std::string_view bytes);

}  // namespace galactic
