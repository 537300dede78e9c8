#pragma once
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "dynamics/episodes/comparison.h"
#include "galactic/error.h"

namespace galactic::dynamics {

/// The episodes that are done, kept beside the report until that is written, so that a run that is
/// interrupted goes on where it was. A text file: its subject, then one line of JSON per episode;
/// numbers read back exactly. Threads may add at the same time.
class Journal {
 public:
  /// `subject`: all that decides what comes out, in one line. A journal of another subject is begun
  /// anew, and lines that are damaged, as the last one of a killed run may be, do not count. Fails
  /// with kIo.
  [[nodiscard]] static Result<std::unique_ptr<Journal>> open(const std::filesystem::path& path,
                                                             std::string_view subject);

  /// Those that were done before, by their numbers in the run.
  [[nodiscard]] const std::map<std::size_t, EpisodeComparison>& done() const { return done_; }
  /// Fails with kIo.
  [[nodiscard]] Result<void> add(std::size_t number, const EpisodeComparison& comparison);
  /// After the report is written.
  void remove();

 private:
  explicit Journal(std::filesystem::path path) : path_(std::move(path)) {}
  /// Returns what is kept of the file.
  [[nodiscard]] std::string read(std::string_view subject);

  std::filesystem::path path_;
  std::mutex mutex_;
  std::ofstream stream_;
  std::map<std::size_t, EpisodeComparison> done_;
};

}  // namespace galactic::dynamics
