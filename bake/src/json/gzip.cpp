#include "json/gzip.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <limits>

namespace galactic::bake {
namespace {

/// zlib's code for a window of 32 KiB in the wrapping of gzip.
constexpr int kGzipWindow = 15 + 16;
constexpr std::size_t kSmallestOutput = std::size_t{64} << 10U;

/// Ends the stream whatever happens.
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

/// The bytes that zlib is given at once are counted in an unsigned int.
uInt atOnce(std::size_t bytes) {
  return static_cast<uInt>(
      std::min<std::size_t>(bytes, std::numeric_limits<uInt>::max() / std::size_t{2}));
}

/// Inflates member after member into one text.
class Gunzip {
 public:
  Gunzip(std::span<const std::byte> bytes, const std::string& where, std::size_t max_bytes)
      : in_(bytes), where_(where), max_bytes_(max_bytes) {}

  Result<std::string> run() {
    if (!inflater_.ready()) {
      return fail(ErrorCode::kInternal, where_, "zlib cannot begin to decompress");
    }
    while (!in_.empty()) {
      if (auto done = member(); !done) return tl::unexpected(done.error());
    }
    text_.resize(used_);
    return std::move(text_);
  }

 private:
  [[nodiscard]] tl::unexpected<Error> invalid(std::string message) const {
    return fail(ErrorCode::kInvalidInput, where_, std::move(message));
  }

  /// One member, from the beginning of what is left.
  Result<void> member() {
    if (!isGzip(in_)) {
      return invalid(
          fmt::format("has {} bytes behind its gzip data that are none; is it whole?", in_.size()));
    }
    inflateReset(&inflater_.stream());
    while (true) {
      if (auto room = makeRoom(); !room) return room;
      const int code = step();
      if (code == Z_STREAM_END) return makeRoom();
      if (code != Z_OK && code != Z_BUF_ERROR) {
        return invalid("is damaged: its gzip data cannot be decompressed; fetch or make it again");
      }
      if (in_.empty() && used_ < text_.size()) {
        return invalid("ends in the middle of its gzip data; fetch or make it again");
      }
    }
  }

  /// Room for the next bytes, or the failure of a text that is too long, which one byte more than
  /// is allowed tells from one that just fits.
  Result<void> makeRoom() {
    if (used_ > max_bytes_) {
      return invalid(
          fmt::format("holds more than {} bytes, at most so many are read; split it", max_bytes_));
    }
    if (used_ < text_.size()) return {};
    text_.resize(std::min(max_bytes_ + 1, std::max(kSmallestOutput, 2 * text_.size())));
    return {};
  }

  int step() {
    z_stream& stream = inflater_.stream();
    const uInt given = atOnce(in_.size());
    const uInt room = atOnce(text_.size() - used_);
    stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(in_.data()));
    stream.avail_in = given;
    stream.next_out = reinterpret_cast<Bytef*>(text_.data() + used_);
    stream.avail_out = room;
    const int code = inflate(&stream, Z_NO_FLUSH);
    in_ = in_.subspan(given - stream.avail_in);
    used_ += room - stream.avail_out;
    return code;
  }

  std::span<const std::byte> in_;
  const std::string& where_;
  std::size_t max_bytes_;
  Inflater inflater_;
  std::string text_;
  std::size_t used_ = 0;
};

}  // namespace

bool isGzip(std::span<const std::byte> bytes) {
  return bytes.size() >= 2 && bytes[0] == std::byte{0x1f} && bytes[1] == std::byte{0x8b};
}

Result<std::string> gunzip(std::span<const std::byte> bytes, const std::string& where,
                           std::size_t max_bytes) {
  return Gunzip(bytes, where, max_bytes).run();
}

}  // namespace galactic::bake
