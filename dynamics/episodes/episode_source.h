#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>

#include "dynamics/episodes/comparison.h"
#include "dynamics/options.h"
#include "galactic/error.h"
#include "galactic/world.h"

namespace galactic::dynamics {

/// Episodes that are compared: what the simulation did in each, and whose actions the dynamics
/// carry out. Immutable; threads may share it, each with lanes of its own.
class EpisodeSource {
 public:
  EpisodeSource() = default;
  virtual ~EpisodeSource() = default;
  EpisodeSource(const EpisodeSource&) = delete;
  EpisodeSource& operator=(const EpisodeSource&) = delete;
  EpisodeSource(EpisodeSource&&) = delete;
  EpisodeSource& operator=(EpisodeSource&&) = delete;

  [[nodiscard]] virtual std::size_t count() const = 0;
  /// Of the simulation.
  [[nodiscard]] virtual const SimulationOptions& options() const = 0;
  /// One for the calls below. Fails with the errors of EpisodeLane::create.
  [[nodiscard]] virtual Result<std::unique_ptr<EpisodeLane>> makeLane() const = 0;
  /// The n-th episode in the simulation. Fails as the policy does.
  [[nodiscard]] virtual Result<EpisodeTrace> trace(std::size_t n, EpisodeLane& lane) const = 0;
  /// What compareEpisode carries out; `trace` and `lane` must outlive it.
  [[nodiscard]] virtual ActionSource actions(const EpisodeTrace& trace,
                                             EpisodeLane& lane) const = 0;
};

/// The episodes that a recording finishes, the first `most` of them; 0: all. They are replayed.
/// `world` must outlive them. Fails with the errors of RecordingReader::open and tracesOf, with
/// kInvalidInput where there is none, and with kUnsupported where motions have noise or delay.
[[nodiscard]] Result<std::unique_ptr<EpisodeSource>> recordedEpisodes(
    const std::filesystem::path& recording, const World& world, std::size_t most);

/// The episodes of the world that can be started, the first `most` of them; 0: all. A policy plays
/// them: that of the pack `policy`, or where this is empty, the scripted one. `world` must outlive
/// them. Fails with the errors of the policy and of makeLane(), with kInvalidInput where an option
/// of the task is none, and with kUnsupported where motions have noise or delay.
[[nodiscard]] Result<std::unique_ptr<EpisodeSource>> playedEpisodes(
    const std::filesystem::path& policy, const LoopOptions& loop, const World& world,
    std::size_t most);

}  // namespace galactic::dynamics
