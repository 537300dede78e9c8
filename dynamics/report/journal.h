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

/// The finished episodes, kept beside the report until that is written, as lines of JSON whose
/// numbers read back exactly: see Journal. Threads may add records concurrently.
class ComparisonJournal {
 public:
  /// `links`: the robot's number of links. Records that do not fit such a robot are ignored. Fails
  /// as Journal::open does.
  [[nodiscard]] static Result<ComparisonJournal> open(const std::filesystem::path& path,
                                                      std::string_view subject, std::size_t links);

  /// The episodes that were finished before, by their numbers in the run.
  [[nodiscard]] const std::map<std::size_t, EpisodeComparison>& done() const { return done_; }
  /// Fails with kIo.
  [[nodiscard]] Result<void> add(std::size_t number, const EpisodeComparison& comparison);
  /// Removes the journal, after the report is written.
  void remove() { journal_->remove(); }

 private:
  ComparisonJournal(std::unique_ptr<Journal> journal, std::size_t links);

  std::unique_ptr<Journal> journal_;
  std::map<std::size_t, EpisodeComparison> done_;
};

}  // namespace galactic::dynamics
