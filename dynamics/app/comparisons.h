#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "command_line.h"
#include "dynamics/episodes/comparison.h"
#include "dynamics/report/journal.h"
#include "galactic/error.h"
#include "galactic/world.h"
#include "run/learned_run.h"

namespace galactic::dynamics {

/// The episodes that are compared, and how the simulation plays them.
class EpisodePlan {
 public:
  /// Opens the recording or the policy. `world` must outlive the plan. Fails with their errors, and
  /// with kInvalidInput where an option of the task is none or there is no episode.
  [[nodiscard]] static Result<std::unique_ptr<EpisodePlan>> create(const Command& command,
                                                                   const World& world);

  [[nodiscard]] std::size_t count() const { return is_closed_ ? episodes_.size() : traces_.size(); }
  [[nodiscard]] bool isClosedLoop() const { return is_closed_; }
  [[nodiscard]] const SimulationOptions& options() const { return options_; }
  [[nodiscard]] Result<std::unique_ptr<EpisodeLane>> makeLane() const;
  /// The n-th episode in the simulation, recorded or played by the lane. Fails as the policy does.
  [[nodiscard]] Result<EpisodeTrace> trace(std::size_t n, EpisodeLane& lane) const;
  /// What decides the episodes but the recording and the policy, in one line.
  [[nodiscard]] std::string describe() const;

 private:
  explicit EpisodePlan(const World& world) : world_(world) {}
  Result<void> openRecording(const Command& command);
  Result<void> openLoop(const Command& command);

  const World& world_;
  bool is_closed_ = false;
  SimulationOptions options_;
  std::vector<EpisodeTrace> traces_;
  std::vector<std::uint32_t> episodes_;
  std::optional<OpenedPolicy> policy_;
  bool is_deterministic_ = false;
};

/// Compares all episodes of the plan. `journal`: keeps what is done; null: nobody does. The result
/// does not depend on the number of threads. After Ctrl-C or SIGTERM it finishes what has begun,
/// and returns fewer than plan.count(). Fails with the errors of compareEpisode, of the first
/// episode that fails.
[[nodiscard]] Result<std::vector<EpisodeComparison>> compareAll(const EpisodePlan& plan,
                                                                const ComparisonWorlds& worlds,
                                                                const Command& command,
                                                                ComparisonJournal* journal);

}  // namespace galactic::dynamics
