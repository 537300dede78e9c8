#include "json/gzip.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "support/try.h"

namespace galactic::bake {
namespace {

/// zlib's code for a window of 32 KiB in the gzip format.
constexpr int kGzipWindow = 15 + 16;
constexpr std::size_t kPieceBytes = std::size_t{64} << 10U;

/// Owns a zlib stream.
class Inflater {
 public:
  Inflater() : ready_(inflateInit2(&stream_, kGzipWindow) == Z_OK) {}
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  [[nodiscard]] bool ready() const { return ready_; }
  [[nodiscard]] z_stream& stream() { return stream_; }

 private:
  z_stream stream_{};
  bool ready_;
};

/// How many of `bytes` to give to zlib at once, which counts them in an unsigned int.
uInt atOnce(std::size_t bytes) {
  return static_cast<uInt>(
      std::min<std::size_t>(bytes, std::numeric_limits<uInt>::max() / std::size_t{2}));
}

/// Decompresses the members of one file, one after another.
class Gunzip {
 public:
  Gunzip(std::span<const std::byte> bytes, const std::string& where, std::size_t max_bytes)
      : in_(bytes), where_(where), max_bytes_(max_bytes), piece_(kPieceBytes, '\0') {}

  /// Calls `take` with the text, piece by piece. Returns the length of the text.
  template <class Take>
  Result<std::size_t> run(const Take& take) {
    if (!inflater_.ready()) {
      return fail(ErrorCode::kInternal, where_, "zlib cannot begin to decompress");
    }
    while (!in_.empty()) {
      RETURN_IF_ERROR(member(take));
    }
    return length_;
  }

 private:
  [[nodiscard]] tl::unexpected<Error> invalid(std::string message) const {
    return fail(ErrorCode::kInvalidInput, where_, std::move(message));
  }

  /// Decompresses one member at the beginning of the remaining bytes.
  template <class Take>
  Result<void> member(const Take& take) {
    if (!isGzip(in_)) {
      return invalid(fmt::format("has {} bytes after its gzip data that are not gzip; is it whole?",
                                 in_.size()));
    }
    inflateReset(&inflater_.stream());
    while (true) {
      std::size_t made = 0;
      const int code = step(made);
      length_ += made;
      if (length_ > max_bytes_) {
        return invalid(fmt::format("holds more than {} bytes, at most so many are read; split it",
                                   max_bytes_));
      }
      take(std::string_view(piece_).substr(0, made));
      if (code == Z_STREAM_END) return {};
      if (code != Z_OK && code != Z_BUF_ERROR) {
        return invalid("is damaged: its gzip data cannot be decompressed; fetch or make it again");
      }
      if (in_.empty() && made < piece_.size()) {
        return invalid("ends in the middle of its gzip data; fetch or make it again");
      }
    }
  }

  int step(std::size_t& made) {
    z_stream& stream = inflater_.stream();
    const uInt given = atOnce(in_.size());
    const uInt room = atOnce(piece_.size());
    stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(in_.data()));
    stream.avail_in = given;
    stream.next_out = reinterpret_cast<Bytef*>(piece_.data());
    stream.avail_out = room;
    const int code = inflate(&stream, Z_NO_FLUSH);
    in_ = in_.subspan(given - stream.avail_in);
    made = room - stream.avail_out;
    return code;
  }

  std::span<const std::byte> in_;
  const std::string& where_;
  std::size_t max_bytes_;
  Inflater inflater_;
  std::string piece_;
  std::size_t length_ = 0;
};

}  // namespace

bool isGzip(std::span<const std::byte> bytes) {
  return bytes.size() >= 2 && bytes[0] == std::byte{0x1f} && bytes[1] == std::byte{0x8b};
}

Result<std::string> gunzip(std::span<const std::byte> bytes, const std::string& where,
                           std::size_t max_bytes) {
  // Find damage, and text that is too long, before memory is allocated for the text.
  ASSIGN_OR_RETURN(const auto length, Gunzip(bytes, where, max_bytes).run([](std::string_view) {}));
  std::string text;
  text.reserve(length);
  const auto again =
      Gunzip(bytes, where, max_bytes).run([&](std::string_view piece) { text += piece; });
  if (!again) return tl::unexpected(again.error());
  return text;
}

}  // namespace galactic::bake
