#include "view/page_data.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <new>
#include <utility>

namespace galactic {
namespace {

static_assert(std::endian::native == std::endian::little);

/// What a typed array of a browser has to be aligned to.
constexpr std::size_t kAlignment = 8;

std::string_view nameOf(const Chunk::Array& array) {
  switch (array.type) {
    case ChunkType::kU8:
      return "u8";
    case ChunkType::kU16:
      return array.is_planes ? "u16p" : "u16";
    case ChunkType::kU32:
      return "u32";
    case ChunkType::kI32:
      return array.is_planes ? "i32p" : "i32";
    case ChunkType::kF32:
      return "f32";
  }
  return {};
}

template <class T>
std::string planesOf(std::span<const T> values) {
  std::string planes(values.size() * sizeof(T), '\0');
  for (std::size_t n = 0; n < values.size(); ++n) {
    const auto bits = static_cast<std::make_unsigned_t<T>>(values[n]);
    for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
      planes[byte * values.size() + n] = static_cast<char>(bits >> (8 * byte) & 0xFFU);
    }
  }
  return planes;
}

/// Ends the stream whatever happens.
class Deflater {
 public:
  Deflater() {
    // Without memory nothing else is to be said.
    if (deflateInit(&stream_, Z_DEFAULT_COMPRESSION) != Z_OK) throw std::bad_alloc();
  }
  ~Deflater() { deflateEnd(&stream_); }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;
  Deflater(Deflater&&) = delete;
  Deflater& operator=(Deflater&&) = delete;

  std::string run(std::string_view bytes) {
    constexpr std::size_t kAtOnce = std::size_t{1} << 30U;
    std::string out(deflateBound(&stream_, bytes.size()), '\0');
    std::size_t used = 0;
    std::size_t taken = 0;
    int status = Z_OK;
    while (status != Z_STREAM_END) {
      const std::size_t in = std::min(kAtOnce, bytes.size() - taken);
      if (used == out.size()) out.resize(2 * out.size());
      const std::size_t room = std::min(kAtOnce, out.size() - used);
      // zlib reads what next_in points to and never writes it.
      stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + taken));
      stream_.avail_in = static_cast<uInt>(in);
      stream_.next_out = reinterpret_cast<Bytef*>(out.data() + used);
      stream_.avail_out = static_cast<uInt>(room);
      status = deflate(&stream_, taken + in == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
      taken += in - stream_.avail_in;
      used += room - stream_.avail_out;
    }
    out.resize(used);
    return out;
  }

 private:
  z_stream stream_{};
};

}  // namespace

void Chunk::append(Array array, std::span<const std::byte> bytes) {
  bytes_.resize((bytes_.size() + kAlignment - 1) / kAlignment * kAlignment);
  array.at = bytes_.size();
  bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  arrays_.push_back(std::move(array));
}

void Chunk::add(std::string_view name, std::span<const std::uint8_t> values) {
  append({.name = std::string(name), .type = ChunkType::kU8, .count = values.size()},
         std::as_bytes(values));
}

void Chunk::add(std::string_view name, std::span<const float> values) {
  append({.name = std::string(name), .type = ChunkType::kF32, .count = values.size()},
         std::as_bytes(values));
}

void Chunk::add(std::string_view name, std::span<const std::uint32_t> values) {
  append({.name = std::string(name), .type = ChunkType::kU32, .count = values.size()},
         std::as_bytes(values));
}

void Chunk::addPlanes(std::string_view name, std::span<const std::uint16_t> values) {
  const std::string planes = planesOf(values);
  append({.name = std::string(name),
          .type = ChunkType::kU16,
          .is_planes = true,
          .count = values.size()},
         std::as_bytes(std::span(planes)));
}

void Chunk::addPlanes(std::string_view name, std::span<const std::int32_t> values) {
  const std::string planes = planesOf(values);
  append({.name = std::string(name),
          .type = ChunkType::kI32,
          .is_planes = true,
          .count = values.size()},
         std::as_bytes(std::span(planes)));
}

void PageData::add(JsonWriter& json, std::string_view key, const Chunk& chunk) {
  json.begin(key, '{');
  json.number("chunk", chunks_.size());
  json.number("bytes", chunk.bytes().size());
  json.begin("arrays", '[');
  for (const Chunk::Array& array : chunk.arrays()) {
    json.raw("", fmt::format("[{}, \"{}\", {}, {}]", jsonString(array.name), nameOf(array),
                             array.at, array.count));
  }
  json.end(']');
  json.end('}');
  chunks_.push_back(packedText(chunk.bytes()));
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t block = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      block = block << 8U | (n < count ? static_cast<std::uint8_t>(bytes[at + n]) : 0U);
    }
    for (std::size_t n = 0; n < 4; ++n) {
      text += n <= count ? kDigits[block >> (18U - 6U * static_cast<unsigned>(n)) & 63U] : '=';
    }
  }
  return text;
}

std::string packedText(std::string_view bytes) { return base64(Deflater().run(bytes)); }

}  // namespace galactic
