#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>

#include "dynamics/episodes/comparison.h"
#include "dynamics/options.h"
#include "galactic/error.h"
#include "galactic/world.h"

namespace galactic::dynamics {

/// The episodes to compare: what the simulation did in each, and the actions for the dynamics.
/// Immutable; threads may share it, each with its own lanes.
class EpisodeSource {
 public:
  EpisodeSource() = default;
  virtual ~EpisodeSource() = default;
  EpisodeSource(const EpisodeSource&) = delete;
  EpisodeSource& operator=(const EpisodeSource&) = delete;
  EpisodeSource(EpisodeSource&&) = delete;
  EpisodeSource& operator=(EpisodeSource&&) = delete;

  [[nodiscard]] virtual std::size_t count() const = 0;
  /// The options of the simulation.
  [[nodiscard]] virtual const SimulationOptions& options() const = 0;
  /// A lane for the calls below. Fails with the errors of EpisodeLane::create.
  [[nodiscard]] virtual Result<std::unique_ptr<EpisodeLane>> makeLane() const = 0;
  /// The n-th episode in the simulation. Fails as the policy does.
  [[nodiscard]] virtual Result<EpisodeTrace> trace(std::size_t n, EpisodeLane& lane) const = 0;
  /// The actions for compareEpisode; `trace` and `lane` must outlive them.
  [[nodiscard]] virtual ActionSource actions(const EpisodeTrace& trace,
                                             EpisodeLane& lane) const = 0;
};

/// The first `most` finished episodes of a recording, or all for 0, to be replayed. `world` must
/// outlive the result. Fails with the errors of RecordingReader::open and tracesOf, with
/// kInvalidInput if there are none, and with kUnsupported if motions have noise or delay.
[[nodiscard]] Result<std::unique_ptr<EpisodeSource>> recordedEpisodes(
    const std::filesystem::path& recording, const World& world, std::size_t most);

/// The first `most` episodes of the world in which the robot can start, or all for 0. They are
/// played by the policy in the pack `policy`, or by the scripted one if that is empty. `world` must
/// outlive the result. Fails with the errors of the policy and of makeLane(), with kInvalidInput
/// for an invalid option of the task, and with kUnsupported if motions have noise or delay.
[[nodiscard]] Result<std::unique_ptr<EpisodeSource>> playedEpisodes(
    const std::filesystem::path& policy, const LoopOptions& loop, const World& world,
    std::size_t most);

}  // namespace galactic::dynamics
