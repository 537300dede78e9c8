#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"

namespace galactic {

/// What a ScriptedPolicy is doing in an env.
enum class ScriptedPhase : std::uint8_t {
  /// Drive to the target, reach for it and grasp it.
  kPick = 0,
  /// Lift it, carry it to the goal, set it down and let go.
  kPlace = 1,
  /// End the episode: the target lies at the goal (or is held, if that is the task).
  kFinish = 2,
  /// See ScriptedTrouble.
  kGaveUp = 3,
};

/// Why a ScriptedPolicy gave up, or last planned anew.
enum class ScriptedTrouble : std::uint8_t {
  kNone = 0,
  /// The base cannot drive to any place near the target or the goal.
  kNoWayToTarget = 1,
  kNoWayToGoal = 2,
  /// The base can drive near it, but the arm reaches it from none of these places without
  /// penetrating anything.
  kNoGrasp = 3,
  kNoPlacement = 4,
  /// The arm cannot be folded for driving.
  kNoFold = 5,
  /// The robot did not make progress with the plan.
  kStuck = 6,
  /// The hand closed on nothing or on another object, or the target came to rest elsewhere.
  kMissed = 7,
};

/// The name of a trouble in lower case, for tables: "no way to target".
[[nodiscard]] std::string_view nameOf(ScriptedTrouble trouble);

/// Solves episodes of Rearrange and Mobile Pick with a plan, from the whole state of an env rather
/// than from observations: shows that a world's task can be solved, and by which actions. In each
/// env it
/// - searches the floor for the cheapest way (A*) to a place from which the arm, by inverse
///   kinematics and a planned motion, reaches the target; drives there and grasps it;
/// - lifts it, folds the arm, drives on to a place from which the arm brings it just above the goal
///   as upright as it has to lie there, lets go, and terminates.
/// Works for any arm, including arms of few joints, with slides, or that reach sideways: the base
/// turns the side on which the arm reaches towards the target or goal, and helps with a turn if the
/// arm alone cannot choose both place and direction of the hand.
/// If the simulation moves the robot differently from the plan, the policy steers back to the plan,
/// lets the arm reach from where the base has ended up, or plans again, a few times. If it finds
/// nothing, it gives up: its actions are then zero, except for the hand, which keeps what it holds.
/// This makes it robust to noise of motion (RobotNoise). If actions arrive late, it acts from where
/// the robot will be when they arrive, and lets all of them arrive before it plans.
///
/// Deterministic: what it does in an env depends only on that env's states. Plans take tens of
/// milliseconds and allocate memory; `options.threads` threads make them. Not safe to call from
/// several threads at once.
class ScriptedPolicy {
 public:
  /// For a batch of `options.envs` envs that was made from the same world and options. Fails with
  /// kUnsupported if the task is TaskKind::kNone, or if the thresholds of ActionOptions leave no
  /// value that triggers something, or none that does not.
  [[nodiscard]] static Result<ScriptedPolicy> create(const World& world,
                                                     const SimulationOptions& options);
  ~ScriptedPolicy();
  ScriptedPolicy(ScriptedPolicy&&) noexcept;
  ScriptedPolicy& operator=(ScriptedPolicy&&) noexcept;

  /// Computes the actions of the next step of all envs. `actions` has envs * actionCount()
  /// elements, as BatchSimulator::step takes them. Call it once before each step. If others act in
  /// between, or have acted before, the policy goes on, or plans, from where the robot is then.
  /// `where` (of size envs, or empty: all) is 0 for envs in which others act: the policy leaves
  /// their actions as they are and plans nothing. Throws ErrorException with kInvalidInput, and
  /// changes nothing, when a step of `simulator` has begun, when its world or number of envs
  /// differs from the policy's, and when `actions` or `where` has the wrong length.
  void act(const BatchSimulator& simulator, std::span<float> actions,
           std::span<const std::uint8_t> where = {});

  /// How often the policy plans in an episode before it gives up. It may replan the arm's part of a
  /// plan a few times more.
  void allowPlans(std::uint32_t most);
  static constexpr std::uint32_t kMostPlans = 8;

  /// Whether motors move the joints, so that joints arrive late, or not quite, at the positions
  /// that actions ask for; takes effect in episodes that begin afterwards. Each joint action then
  /// moves the position that was asked for before. The policy plans from that position, waits for
  /// joints that lag far behind, and waits for all joints to arrive before it drives, grasps or
  /// lets go. False by default.
  void expectLag(bool lags);

  /// After the last call of act(). Throws ErrorException with kInvalidInput if `env` does not
  /// exist.
  [[nodiscard]] ScriptedPhase phase(std::size_t env) const;
  [[nodiscard]] ScriptedTrouble trouble(std::size_t env) const;

 private:
  class Impl;
  explicit ScriptedPolicy(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace galactic
