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
  /// `subject`: all that decides what comes out, in one line. A journal of another subject is begun
  /// anew. What is damaged, as the last record of a killed process may be, does not count, nor does
  /// what comes after it. Fails with kIo, and with kInvalidInput where `path` is a file of another
  /// kind, which stays as it is.
  [[nodiscard]] static Result<std::unique_ptr<Journal>> open(const std::filesystem::path& path,
                                                             std::string_view subject);

  /// Those that were there when it was opened, in their order.
  [[nodiscard]] const std::vector<std::string>& records() const { return records_; }
  /// Threads may add at the same time. Fails with kIo.
  [[nodiscard]] Result<void> add(std::string_view record);
  /// After the output is written; nothing may be added then.
  void remove();

 private:
  explicit Journal(std::filesystem::path path) : path_(std::move(path)) {}
  /// Returns what is kept of the file.
  [[nodiscard]] Result<std::string> read(std::string_view subject);

  std::filesystem::path path_;
  std::mutex mutex_;
  std::ofstream stream_;
  std::vector<std::string> records_;
};

}  // namespace galactic
