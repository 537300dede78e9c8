#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"
#include "support/files/atomic_file.h"

namespace galactic {

/// Identifies a pack by values from its header, so that nothing is hashed again. The memory layout
/// is that of a recording.
struct PackStamp {
  std::uint32_t kind = 0;
  std::uint32_t reserved = 0;
  std::uint64_t payload_bytes = 0;
  std::uint64_t payload_xxh64 = 0;

  friend bool operator==(const PackStamp&, const PackStamp&) = default;
  friend bool operator<(const PackStamp& a, const PackStamp& b) {
    return std::tie(a.kind, a.payload_bytes, a.payload_xxh64) <
           std::tie(b.kind, b.payload_bytes, b.payload_xxh64);
  }
};

/// The stamps of a world's packs in ascending order: the same for any order of the packs.
[[nodiscard]] std::vector<PackStamp> stampsOf(const World& world);

/// XXH3 of what the last step returned: observations, rewards, dones and successes of all envs.
[[nodiscard]] std::uint64_t digestOf(const BatchSimulator& simulator);

/// What was recorded.
struct RecordingSubject {
  SimulationOptions options;
  /// Actions per env.
  std::uint32_t actions = 0;
  std::vector<PackStamp> packs;

  [[nodiscard]] std::size_t actionCount() const {
    return std::size_t{options.envs} * std::size_t{actions};
  }
};

/// Writes a recording, little-endian: a header of 64 bytes (magic "GALRECRD", version, counts, and
/// an XXH64 of header, stamps and options), the stamps, the options as lines "name=value", and for
/// each step its actions (floats, env by env), the digest of what it returned, and a hash of both.
/// The file appears when it is finished.
class RecordingWriter {
 public:
  /// Fails with kIo.
  [[nodiscard]] static Result<RecordingWriter> create(const std::filesystem::path& path,
                                                      const RecordingSubject& subject);

  [[nodiscard]] Result<void> append(std::span<const float> actions, std::uint64_t digest);
  /// Must be the last call.
  [[nodiscard]] Result<void> finish();

 private:
  RecordingWriter(AtomicFile file, const RecordingSubject& subject);
  [[nodiscard]] Result<void> writeFront();

  AtomicFile file_;
  RecordingSubject subject_;
  std::string lines_;
  std::uint64_t steps_ = 0;
};

/// Reads a recording step by step. Treats it as untrusted input.
class RecordingReader {
 public:
  /// Fails with kIo (cannot be read), kUnsupported (a later version) and kInvalidInput (not a
  /// recording, damaged, or not of the size that its header gives).
  [[nodiscard]] static Result<RecordingReader> open(const std::filesystem::path& path);

  [[nodiscard]] const RecordingSubject& subject() const { return subject_; }
  [[nodiscard]] std::uint64_t steps() const { return steps_; }
  [[nodiscard]] const std::string& where() const { return where_; }

  /// Reads the next step into `actions`, subject().actionCount() of them, and returns its digest.
  /// Fails with kIo, and with kInvalidInput if the step is damaged. Call it at most steps() times.
  [[nodiscard]] Result<std::uint64_t> next(std::span<float> actions);

 private:
  RecordingReader() = default;

  std::ifstream file_;
  std::string where_;
  RecordingSubject subject_;
  std::uint64_t steps_ = 0;
  std::uint64_t read_ = 0;
};

/// Checks that `world` is the one that was recorded; otherwise fails with kInvalidInput, naming the
/// kind of the first pack that differs.
[[nodiscard]] Result<void> checkWorld(const RecordingReader& recording, const World& world);

}  // namespace galactic
