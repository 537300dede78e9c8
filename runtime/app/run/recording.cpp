#include "run/recording.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include "command_line/option_lines.h"
#include "galactic/pack_header.h"
#include "support/text/printable.h"
#include "support/try.h"

namespace galactic {
namespace {

constexpr std::array<char, 8> kMagic{'G', 'A', 'L', 'R', 'E', 'C', 'R', 'D'};
constexpr std::uint32_t kVersion = 1;
/// Limits far beyond any run, so that sizes cannot overflow.
constexpr std::uint32_t kMostEnvs = 1U << 20U;
constexpr std::uint32_t kMostActions = 1U << 12U;
constexpr std::uint32_t kMostPacks = 1U << 20U;
constexpr std::uint32_t kMostText = 1U << 16U;

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t envs = 0;
  std::uint32_t actions = 0;
  std::uint32_t packs = 0;
  std::uint32_t text_bytes = 0;
  std::uint32_t reserved = 0;
  std::uint64_t steps = 0;
  std::array<std::uint64_t, 2> reserved_words{};
  /// Hash of the header with this field 0, the stamps and the text.
  std::uint64_t hash = 0;
};
static_assert(sizeof(Header) == 64);
static_assert(sizeof(PackStamp) == 24);

/// The data after the actions of a step.
struct StepTail {
  std::uint64_t digest = 0;
  /// Hash of the step's number, actions and digest.
  std::uint64_t hash = 0;
};

template <class T>
std::span<const std::byte> bytesOf(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

/// The hash for the header.
std::uint64_t hashOf(Header header, std::span<const PackStamp> stamps, std::string_view text) {
  header.hash = 0;
  XXH64_state_t state;
  XXH64_reset(&state, 0);
  XXH64_update(&state, &header, sizeof(header));
  XXH64_update(&state, stamps.data(), stamps.size_bytes());
  XXH64_update(&state, text.data(), text.size());
  return XXH64_digest(&state);
}

std::uint64_t hashOf(std::uint64_t step, std::span<const float> actions, std::uint64_t digest) {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  XXH3_64bits_update(&state, &step, sizeof(step));
  XXH3_64bits_update(&state, actions.data(), actions.size_bytes());
  XXH3_64bits_update(&state, &digest, sizeof(digest));
  return XXH3_64bits_digest(&state);
}

/// Reads bytes of the file into `out`; returns false at the end of the file.
bool fill(std::ifstream& file, std::span<std::byte> out) {
  file.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size()));
  return file.good() || (file.eof() && file.gcount() == static_cast<std::streamsize>(out.size()));
}

tl::unexpected<Error> damaged(const std::string& where, std::string message) {
  return fail(ErrorCode::kInvalidInput, where, std::move(message) + "; record it again");
}

/// Reads the header and checks it by itself: magic, version, counts, size of the file.
Result<Header> readHeader(std::ifstream& file, const std::string& where, std::uint64_t size) {
  Header header;
  if (size < sizeof(Header) || !fill(file, std::as_writable_bytes(std::span(&header, 1))) ||
      header.magic != kMagic) {
    return fail(ErrorCode::kInvalidInput, where,
                "is not a recording; give a file that --record wrote");
  }
  if (header.version != kVersion) {
    return fail(ErrorCode::kUnsupported, where,
                fmt::format("is a recording of format version {}, expected {}; use the version of "
                            "galactic-run that wrote it",
                            header.version, kVersion));
  }
  const bool makes_sense = header.envs >= 1 && header.envs <= kMostEnvs && header.actions >= 1 &&
                           header.actions <= kMostActions && header.packs <= kMostPacks &&
                           header.text_bytes <= kMostText;
  if (!makes_sense) return damaged(where, "has a header with impossible counts");
  const std::uint64_t front =
      sizeof(Header) + std::uint64_t{header.packs} * sizeof(PackStamp) + header.text_bytes;
  const std::uint64_t step =
      std::uint64_t{header.envs} * header.actions * sizeof(float) + sizeof(StepTail);
  const bool fits =
      size >= front && (size - front) % step == 0 && (size - front) / step == header.steps;
  if (!fits) {
    return damaged(where, fmt::format("has {} bytes, which is not what {} steps of {} envs take",
                                      size, header.steps, header.envs));
  }
  return header;
}

std::string kindText(const PackStamp& stamp) {
  return printable(packKindName(static_cast<PackKind>(stamp.kind)));
}

}  // namespace

std::vector<PackStamp> stampsOf(const World& world) {
  std::vector<PackStamp> stamps;
  stamps.reserve(world.packs().size());
  for (const PackFile& pack : world.packs()) {
    const PackHeader& header = pack.header();
    stamps.push_back({.kind = static_cast<std::uint32_t>(header.kind),
                      .payload_bytes = header.payload_bytes,
                      .payload_xxh64 = header.payload_xxh64});
  }
  std::sort(stamps.begin(), stamps.end());
  return stamps;
}

std::uint64_t digestOf(const BatchSimulator& simulator) {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  const auto add = [&state](auto values) {
    XXH3_64bits_update(&state, values.data(), values.size_bytes());
  };
  add(simulator.observations());
  add(simulator.rewards());
  add(simulator.dones());
  add(simulator.successes());
  return XXH3_64bits_digest(&state);
}

RecordingWriter::RecordingWriter(AtomicFile file, const RecordingSubject& subject)
    : file_(std::move(file)), subject_(subject), lines_(optionLines(subject.options)) {}

Result<RecordingWriter> RecordingWriter::create(const std::filesystem::path& path,
                                                const RecordingSubject& subject) {
  ASSIGN_OR_RETURN(AtomicFile file, AtomicFile::create(path));
  RecordingWriter writer(std::move(file), subject);
  RETURN_IF_ERROR(writer.writeFront());
  return writer;
}

Result<void> RecordingWriter::writeFront() {
  const Header unfinished;
  if (auto written = file_.append(bytesOf(unfinished)); !written) return written;
  if (auto written = file_.append(std::as_bytes(std::span(subject_.packs))); !written) {
    return written;
  }
  return file_.append(std::as_bytes(std::span(lines_)));
}

Result<void> RecordingWriter::append(std::span<const float> actions, std::uint64_t digest) {
  const StepTail tail{digest, hashOf(steps_, actions, digest)};
  ++steps_;
  if (auto written = file_.append(std::as_bytes(actions)); !written) return written;
  return file_.append(bytesOf(tail));
}

Result<void> RecordingWriter::finish() {
  Header header;
  header.envs = subject_.options.envs;
  header.actions = subject_.actions;
  header.packs = static_cast<std::uint32_t>(subject_.packs.size());
  header.text_bytes = static_cast<std::uint32_t>(lines_.size());
  header.steps = steps_;
  header.hash = hashOf(header, subject_.packs, lines_);
  if (auto written = file_.overwrite(0, bytesOf(header)); !written) return written;
  return file_.publish();
}

Result<RecordingReader> RecordingReader::open(const std::filesystem::path& path) {
  RecordingReader reader;
  reader.where_ = path.string();
  std::error_code problem;
  const std::uint64_t size = std::filesystem::file_size(path, problem);
  if (!problem) reader.file_.open(path, std::ios::binary);
  if (problem || !reader.file_) {
    return fail(ErrorCode::kIo, reader.where_,
                "cannot read the recording; check the name and the permissions");
  }
  ASSIGN_OR_RETURN(const Header header, readHeader(reader.file_, reader.where_, size));
  RecordingSubject& subject = reader.subject_;
  subject.packs.resize(header.packs);
  std::string text(header.text_bytes, '\0');
  if (!fill(reader.file_, std::as_writable_bytes(std::span(subject.packs))) ||
      !fill(reader.file_, std::as_writable_bytes(std::span(text)))) {
    return fail(ErrorCode::kIo, reader.where_, "cannot be read to its end");
  }
  if (hashOf(header, subject.packs, text) != header.hash) {
    return damaged(reader.where_, "has a header that does not match its hash");
  }
  ASSIGN_OR_RETURN(SimulationOptions options, parseOptionLines(text, reader.where_));
  subject.options = options;
  subject.actions = header.actions;
  reader.steps_ = header.steps;
  if (subject.options.envs != header.envs) {
    return damaged(reader.where_, fmt::format("has {} envs in its header and {} in its options",
                                              header.envs, subject.options.envs));
  }
  return reader;
}

Result<std::uint64_t> RecordingReader::next(std::span<float> actions) {
  StepTail tail;
  if (!fill(file_, std::as_writable_bytes(actions)) ||
      !fill(file_, std::as_writable_bytes(std::span(&tail, 1)))) {
    return fail(ErrorCode::kIo, where_, fmt::format("cannot be read at step {}", read_));
  }
  if (hashOf(read_, actions, tail.digest) != tail.hash) {
    return damaged(where_, fmt::format("is damaged at step {}: the hash does not match", read_));
  }
  ++read_;
  return tail.digest;
}

Result<void> checkWorld(const RecordingReader& recording, const World& world) {
  const std::vector<PackStamp> now = stampsOf(world);
  const std::vector<PackStamp>& then = recording.subject().packs;
  if (now == then) return {};
  const auto [a, b] = std::mismatch(then.begin(), then.end(), now.begin(), now.end());
  const std::string kind = a != then.end() ? kindText(*a) : kindText(*b);
  return fail(
      ErrorCode::kInvalidInput, recording.where(),
      fmt::format("was recorded with another world: {} packs then, {} now, and one of kind {} "
                  "is another; open the packs that it was recorded with",
                  then.size(), now.size(), kind));
}

}  // namespace galactic
