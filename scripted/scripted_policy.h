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

/// What a ScriptedPolicy is about in an env.
enum class ScriptedPhase : std::uint8_t {
  /// Drive to the target, reach for it and grasp it.
  kPick = 0,
  /// Lift it, carry it to the goal, set it down and let go.
  kPlace = 1,
  /// The target lies at the goal (or is held, where that is the task): say so.
  kFinish = 2,
  /// See ScriptedTrouble.
  kGaveUp = 3,
};

/// Why a ScriptedPolicy gave up, or planned anew for the last time.
enum class ScriptedTrouble : std::uint8_t {
  kNone = 0,
  /// The base cannot drive to any place near target or goal.
  kNoWayToTarget = 1,
  kNoWayToGoal = 2,
  /// From no such place the arm reaches it without penetrating anything.
  kNoGrasp = 3,
  kNoPlacement = 4,
  /// The arm cannot be folded for driving.
  kNoFold = 5,
  /// The robot did not get on with the plan.
  kStuck = 6,
  /// The hand closed on nothing or on another object, or the target came to rest elsewhere.
  kMissed = 7,
};

/// The name of a trouble in lower case, for tables: "no way to target".
[[nodiscard]] std::string_view nameOf(ScriptedTrouble trouble);

/// Solves episodes of Rearrange and Mobile Pick with a plan, from the whole state of an env rather
/// than from observations: shows that a world's task can be solved, and by what actions. For each
/// env it
/// - searches the floor for the cheapest way (A*) to a place from which the arm, by inverse
///   kinematics and a planned motion, reaches the target; drives there and grasps it;
/// - lifts it, folds the arm, drives on to a place from which the arm brings it just over the goal,
///   as upright as it has to lie there, lets go, and terminates.
/// Works for any arm, also one of few joints, with slides, or that reaches sideways: the base turns
/// the side on which the arm reaches towards what it is about, and helps with a turn where the arm
/// cannot choose place and direction of the hand alone.
/// Where the simulation moves the robot otherwise than planned, it steers back to the plan, lets
/// the arm reach from where the base has come to, or plans again, a few times; when nothing is
/// found it gives up: its actions are zero, but for the hand, which keeps what it holds. So it
/// bears noise of motion (RobotNoise). Where actions arrive late, it acts from where the robot will
/// be when they do, and lets all of them arrive before it plans.
///
/// Deterministic: what it does in an env depends on that env's states only. Plans take some tens of
/// milliseconds and allocate; `options.threads` threads make them. Not safe to call from several
/// threads at once.
class ScriptedPolicy {
 public:
  /// For a batch of `options.envs` envs that was made from the same world and options. Fails with
  /// kUnsupported when the task is TaskKind::kNone, or when thresholds of ActionOptions leave no
  /// value that decides, or none that does not.
  [[nodiscard]] static Result<ScriptedPolicy> create(const World& world,
                                                     const SimulationOptions& options);
  ~ScriptedPolicy();
  ScriptedPolicy(ScriptedPolicy&&) noexcept;
  ScriptedPolicy& operator=(ScriptedPolicy&&) noexcept;

  /// The actions of the next step of all envs. Shape of `actions`: envs * actionCount(), as
  /// BatchSimulator::step takes them. Call it once before each step. Where others act meanwhile, or
  /// have acted before, it goes on, or plans, from where the robot is then. `where` (of size envs,
  /// or empty: all) is 0 for envs in which others act: the policy leaves their actions as they are,
  /// and plans nothing. Throws ErrorException with kInvalidInput, and changes nothing, when a step
  /// of `simulator` has begun, when it has another world or another number of envs than the policy,
  /// and when `actions` or `where` has another length.
  void act(const BatchSimulator& simulator, std::span<float> actions,
           std::span<const std::uint8_t> where = {});

  /// How often it plans in an episode before it gives up. The arm's part of a plan may be planned a
  /// few times more.
  void allowPlans(std::uint32_t most);
  static constexpr std::uint32_t kMostPlans = 8;

  /// Whether motors move the joints, so that they get later to where actions ask them to be, or not
  /// quite; in episodes that begin from now on. Each joint action moves what its joint is asked to
  /// be from what it was asked before. The policy then plans from there, waits for joints that lag
  /// far behind, and until they are there before it drives, grasps or lets go. False at first.
  void expectLag(bool lags);

  /// Of the last call of act. An `env` that there is not throws ErrorException with kInvalidInput.
  [[nodiscard]] ScriptedPhase phase(std::size_t env) const;
  [[nodiscard]] ScriptedTrouble trouble(std::size_t env) const;

 private:
  class Impl;
  explicit ScriptedPolicy(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace galactic
