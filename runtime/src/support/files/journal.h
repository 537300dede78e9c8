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

/// What long work has done, kept in a file beside its output until that is written, so that work
/// that is interrupted or killed goes on where it was. The file begins with its subject; each
/// record, any bytes, comes with its size and hash.
class Journal {
 public:
  /// `subject`: all that decides what comes out, in one line. A journal of another subject holds
  /// nothing; it stays as it is until the first record is added, in its place. What is damaged, as
  /// the last record of a killed process may be, does not count, nor does what comes after it.
  /// Fails with kIo, and with kInvalidInput where `path` is a file of another kind, which stays.
  [[nodiscard]] static Result<std::unique_ptr<Journal>> open(const std::filesystem::path& path,
                                                             std::string_view subject);

  /// Those that were there when it was opened, in their order; they live as long as this.
  [[nodiscard]] const std::vector<std::string_view>& records() const { return records_; }
  /// Threads may add at the same time. Fails with kIo, and from then on always.
  [[nodiscard]] Result<void> add(std::string_view record);
  /// After the output is written; nothing may be added then.
  void remove();

 private:
  explicit Journal(std::filesystem::path path) : path_(std::move(path)) {}
  [[nodiscard]] Result<void> read(std::string_view subject);
  /// Makes the file what is kept of it.
  [[nodiscard]] Result<void> begin();

  std::filesystem::path path_;
  std::mutex mutex_;
  /// What the file begins with: its subject, and the records.
  std::string kept_;
  /// Whether the file that is there has this subject.
  bool is_own_ = false;
  /// Open from the first record on.
  std::ofstream stream_;
  /// In `kept_`.
  std::vector<std::string_view> records_;
};

}  // namespace galactic
