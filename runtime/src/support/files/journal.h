#pragma once
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/error.h"

namespace galactic {

/// A log of what a long job has done, kept in a file beside the job's output until the output is
/// written, so that a job that is interrupted or killed can resume. The file begins with its
/// subject; each record (any bytes) is stored with its size and hash.
class Journal {
 public:
  /// `subject`: everything that determines the output, in one line. A journal of another subject
  /// counts as empty; its file stays as it is until the first added record replaces it. A damaged
  /// record, such as the last one of a killed process, is ignored, and so is everything after it.
  /// Fails with kIo, and with kInvalidInput if `path` is a file of another kind, which is left
  /// alone.
  [[nodiscard]] static Result<std::unique_ptr<Journal>> open(const std::filesystem::path& path,
                                                             std::string_view subject);

  /// The records that were there when the journal was opened, in order; they live as long as the
  /// journal.
  [[nodiscard]] const std::vector<std::string_view>& records() const { return records_; }
  /// Several threads may add at the same time. Fails with kIo; after a failure, every call fails.
  [[nodiscard]] Result<void> add(std::string_view record);
  /// Call it after the output is written; add nothing afterwards.
  void remove();

 private:
  explicit Journal(std::filesystem::path path) : path_(std::move(path)) {}
  [[nodiscard]] Result<void> read(std::string_view subject);
  /// Rewrites the file with `kept_` alone.
  [[nodiscard]] Result<void> begin();

  std::filesystem::path path_;
  std::mutex mutex_;
  /// The beginning of the file: its subject and the records that were read.
  std::string kept_;
  /// Whether the existing file has this subject.
  bool is_own_ = false;
  /// Open from the first record on.
  std::ofstream stream_;
  /// Views into `kept_`.
  std::vector<std::string_view> records_;
};

}  // namespace galactic
