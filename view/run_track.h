#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/pose.h"
#include "galactic/world.h"

namespace galactic {

/// An object that is elsewhere from a frame on.
struct ObjectMove {
  std::uint32_t frame = 0;
  /// Index into the placements of the frame's episode.
  std::uint32_t placement = 0;
  Pose world_from_object;
};

/// What one env did. Frame 0 is its state before the first step, frame n that after n steps: where
/// a step ends an episode, the frame is the start of the next one.
struct EnvTrack {
  // One per frame.
  std::vector<std::uint32_t> episodes;
  std::vector<Pose> world_from_root;
  /// Index of the held object among the placements of the frame's episode; -1 for none.
  std::vector<std::int32_t> held;
  /// 1 where the env had played its share of the episodes: see BatchSimulator::idle().
  std::vector<std::uint8_t> idle;
  /// Shape: frames x positions of the robot.
  std::vector<float> joints;
  /// Ascending frames. At the start of an episode, the objects that are not where the episode has
  /// them.
  std::vector<ObjectMove> moves;

  // One per step.
  std::vector<float> rewards;
  std::vector<EpisodeEnd> endings;
  /// RunEvent bits.
  std::vector<std::uint8_t> events;
  /// Shape: steps x actions.
  std::vector<float> actions;
  /// Shape: steps x kTrackDistances, meters.
  std::vector<float> distances;
};

/// What happened in a step.
enum class RunEvent : std::uint8_t {
  kGrasp = 1,
  kDrop = 2,
  kRestore = 4,  ///< A release found no place, and the object went back.
  kRefuse = 8,   ///< The robot kept its pose because something was in the way.
  kSlide = 16,   ///< It was pushed aside.
};

/// The parts of an observation whose lengths are kept.
inline constexpr std::array<std::string_view, 4> kTrackDistances{"robot_target", "grip_target",
                                                                 "robot_goal", "grip_goal"};

/// Keeps what the first envs of a run did, step by step: for pages and animations.
class RunTrack {
 public:
  /// Begins with the state that `simulator` is in. `world` must outlive this; `envs`: how many of
  /// the first ones are kept.
  RunTrack(const World& world, const BatchSimulator& simulator, std::size_t envs);

  /// After a step with `actions`, those of all envs.
  void add(const BatchSimulator& simulator, std::span<const float> actions);

  /// Puts the envs of another run of the same world and task behind these.
  void append(const RunTrack& other);

  [[nodiscard]] const World& world() const { return *world_; }
  [[nodiscard]] const std::vector<EnvTrack>& envs() const { return envs_; }
  /// Of the longest env: those of one run are as long.
  [[nodiscard]] std::size_t steps() const;
  [[nodiscard]] std::size_t actionCount() const { return actions_; }
  [[nodiscard]] std::size_t positionCount() const { return world_->robot().positionCount(); }
  /// Whether only the targets of episodes are there.
  [[nodiscard]] bool isTargetOnly() const { return is_target_only_; }

 private:
  void addFrame(const BatchSimulator& simulator, std::size_t env);
  void addMoves(const BatchSimulator& simulator, std::size_t env);
  void addDistances(const BatchSimulator& simulator, std::size_t env);

  const World* world_;
  std::size_t actions_;
  bool is_target_only_;
  std::array<std::size_t, kTrackDistances.size()> distance_at_{};
  std::vector<EnvTrack> envs_;
  // Of the last frame, for each env.
  std::vector<std::vector<Pose>> objects_;
  std::vector<SimulationStatistics> statistics_;
};

/// A run as steps per second are shown when nobody asks for another speed; simulated time has no
/// other measure.
inline constexpr float kStepsPerSecond = 10;

}  // namespace galactic
