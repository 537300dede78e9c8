#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string_view>

#include "dynamics/episodes/comparison.h"
#include "galactic/error.h"
#include "support/files/journal.h"

namespace galactic::dynamics {

/// The episodes that are done, kept beside the report until that is written, as lines of JSON whose
/// numbers read back exactly: see Journal. Threads may add at the same time.
class ComparisonJournal {
 public:
  /// `links`: how many the robot has. Records that are of no comparison with it do not count. Fails
  /// as Journal::open.
  [[nodiscard]] static Result<ComparisonJournal> open(const std::filesystem::path& path,
                                                      std::string_view subject, std::size_t links);

  /// Those that were done before, by their numbers in the run.
  [[nodiscard]] const std::map<std::size_t, EpisodeComparison>& done() const { return done_; }
  /// Fails with kIo.
  [[nodiscard]] Result<void> add(std::size_t number, const EpisodeComparison& comparison);
  /// After the report is written.
  void remove() { journal_->remove(); }

 private:
  ComparisonJournal(std::unique_ptr<Journal> journal, std::size_t links);

  std::unique_ptr<Journal> journal_;
  std::map<std::size_t, EpisodeComparison> done_;
};

}  // namespace galactic::dynamics
