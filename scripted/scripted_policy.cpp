#include "scripted/scripted_policy.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scripted/foresight.h"
#include "scripted/plan_player.h"
#include "scripted/planner.h"
#include "support/call_check.h"
#include "support/threads/workers.h"
#include "support/try.h"

namespace galactic {
namespace {

constexpr std::uint32_t kNoEpisode = 0xffff'ffff;
/// The value of EnvState::held for an empty hand.
constexpr std::int32_t kNothingHeld = -1;
/// How often the arm's part of a plan is replanned before the whole plan is.
constexpr std::uint32_t kMostReaches = 6;

/// The situation of an env.
struct Situation {
  EnvState state;
  /// How late actions arrive, steps.
  std::uint32_t delay = 0;
  /// The predicted state in which the next action arrives.
  EnvState ahead;
};

struct EnvPlan {
  /// When the policy was last asked about the env.
  std::uint32_t episode = kNoEpisode;
  std::uint64_t begun = 0;
  std::uint32_t step = 0;
  /// Where motors were asked to bring the joints; empty if joints always are where actions ask them
  /// to be.
  scripted::Joints asked;
  /// Plays nothing until the first plan is made.
  scripted::PlanPlayer player;
  bool is_planned = false;
  /// The step from which on the hand has done what it was last asked to do, and whether it is
  /// closed then.
  std::uint32_t hand_arrives = 0;
  bool hand_closes = false;
  /// For how many steps the policy has asked for nothing.
  std::uint32_t waited = 0;
  /// Where the current plan ends, and where plans that failed ended.
  scripted::Stance stance;
  std::vector<scripted::Stance> failed;
  ScriptedPhase phase = ScriptedPhase::kPick;
  ScriptedTrouble trouble = ScriptedTrouble::kNone;
  std::uint32_t plans = 0;
  /// How often the arm's part was replanned since the last whole plan.
  std::uint32_t reaches = 0;
};

}  // namespace

std::string_view nameOf(ScriptedTrouble trouble) {
  constexpr std::array<std::string_view, 8> kNames{
      "none",         "no way to target", "no way to goal", "no grasp",
      "no placement", "no fold",          "stuck",          "missed"};
  return kNames[static_cast<std::size_t>(trouble)];
}

class ScriptedPolicy::Impl {
 public:
  Impl(const World& world, const SimulationOptions& options, const scripted::Decisions& decisions)
      : world_(world),
        options_(options),
        decisions_(decisions),
        arm_(world.robot()),
        envs_(options.envs),
        planners_(std::min(detail::threadCount(options.threads), options.envs)),
        faults_(planners_.size()) {
    const std::size_t threads = planners_.size();
    if (threads == 1) return;
    workers_ = std::make_unique<detail::Workers>(threads, [this](std::size_t n) { work(n); });
  }

  void act(const BatchSimulator& simulator, std::span<float> actions,
           std::span<const std::uint8_t> where) {
    check(simulator, actions, where);
    simulator_ = &simulator;
    actions_ = actions;
    where_ = where;
    next_ = 0;
    if (workers_ == nullptr) {
      work(0);
    } else {
      workers_->begin();
      workers_->end();
    }
    for (std::exception_ptr& fault : faults_) {
      if (fault) std::rethrow_exception(std::exchange(fault, nullptr));
    }
  }

  void expectLag(bool lags) { lags_ = lags; }
  void allowPlans(std::uint32_t most) { most_plans_ = most; }

  [[nodiscard]] const EnvPlan& env(const char* call, std::size_t n) const {
    detail::checkIndex(call, "env", n, envs_.size());
    return envs_[n];
  }

 private:
  using Progress = scripted::PlanPlayer::Progress;

  /// Checks what act() requires of its caller.
  void check(const BatchSimulator& simulator, std::span<const float> actions,
             std::span<const std::uint8_t> where) const {
    constexpr const char* kCall = "ScriptedPolicy::act";
    if (simulator.isStepping()) {
      detail::refuseCall(kCall, "found a step that has begun; end it first, with endStep()");
    }
    if (simulator.world().hash() != world_.hash()) {
      detail::refuseCall(kCall,
                         "found a simulator of another world than the one that the policy was made "
                         "for; make a policy for that one, too");
    }
    if (simulator.envCount() != envs_.size()) {
      detail::refuseCall(kCall, "found a simulator of " + std::to_string(simulator.envCount()) +
                                    " envs, expected the " + std::to_string(envs_.size()) +
                                    " that the policy was made for");
    }
    detail::checkLength(kCall, "actions", actions.size(), envs_.size() * simulator.actionCount());
    if (!where.empty()) detail::checkLength(kCall, "where", where.size(), envs_.size());
  }

  /// Acts in one env after another, with the planner of thread `n`, until all envs are taken.
  void work(std::size_t n) noexcept {
    try {
      const std::size_t count = simulator_->actionCount();
      for (std::size_t env = next_++; env < envs_.size(); env = next_++) {
        if (simulator_->idle()[env] != 0 || (!where_.empty() && where_[env] == 0)) continue;
        act(situationOf(env), envs_[env], actions_.subspan(env * count, count), n);
      }
    } catch (...) {
      faults_[n] = std::current_exception();
    }
  }

  [[nodiscard]] Situation situationOf(std::size_t env) const {
    Situation now{.state = simulator_->envState(env),
                  .delay = simulator_->episodeNoise(env).action_delay,
                  .ahead = {}};
    now.ahead = scripted::foreseen(world_.robot(), now.state, simulator_->actionsUnderWay(env));
    return now;
  }

  /// The planner of a thread. Made on demand, because it takes time and memory.
  [[nodiscard]] scripted::Planner& planner(std::size_t thread) {
    std::optional<scripted::Planner>& planner = planners_[thread];
    if (!planner) planner.emplace(world_, options_);
    return *planner;
  }

  void act(const Situation& now, EnvPlan& env, std::span<float> actions, std::size_t thread) {
    const EnvState& state = now.state;
    if (isAnotherEpisode(state, env)) begin(now, env);
    env.episode = state.episode;
    env.begun = state.begun;
    env.step = state.step;
    playOn(now, env, actions, thread);
    if (env.asked.empty()) return;
    const std::span<const ControlledJoint> joints = world_.robot().controlledJoints();
    for (std::size_t n = 0; n < joints.size(); ++n) {
      float& asked = env.asked[joints[n].position];
      const float action = std::clamp(actions[n], -1.0F, 1.0F);
      asked = std::clamp(asked + joints[n].step * action, joints[n].lower, joints[n].upper);
    }
  }

  void playOn(const Situation& now, EnvPlan& env, std::span<float> actions, std::size_t thread) {
    const EnvState& state = now.state;
    while (true) {
      scripted::ActionRow row = holdStill(now, env, actions);
      if (env.phase == ScriptedPhase::kGaveUp) return;
      const float hand = row.grasp;
      const std::span<const float> asked =
          env.asked.empty() ? now.ahead.joint_positions : env.asked;
      const Progress progress =
          env.player.play(arm_, *world_.robot().base(), now.ahead, asked, row);
      if (progress == Progress::kActs) {
        if (row.grasp != hand) decideHand(now, env);
        env.waited = 0;
        return;
      }
      // What to do next depends on the results of the actions so far, so let them all arrive.
      if (env.waited < now.delay) {
        ++env.waited;
        holdStill(now, env, actions);
        return;
      }
      env.waited = 0;
      if (progress == Progress::kOff && reachFromHere(state, env, thread)) continue;
      if (env.is_planned) {
        planNext(state, env, progress, thread);
      } else {
        plan(state, env, thread);
      }
    }
  }

  /// Moves and decides nothing: grasping, letting go and terminating are steps of a plan.
  scripted::ActionRow holdStill(const Situation& now, const EnvPlan& env,
                                std::span<float> actions) const {
    std::ranges::fill(actions, 0.0F);
    const scripted::ActionRow row = scripted::rowOf(ActionLayout::of(world_.robot()), actions);
    row.grasp = closesHand(now, env) ? decisions_.keep : decisions_.stay_open;
    row.terminate = decisions_.go_on;
    return row;
  }

  /// Whether the hand is closed when the next action arrives.
  [[nodiscard]] static bool closesHand(const Situation& now, const EnvPlan& env) {
    return now.state.step < env.hand_arrives ? env.hand_closes : now.state.held >= 0;
  }

  /// Records that the next action opens or closes the hand.
  static void decideHand(const Situation& now, EnvPlan& env) {
    env.hand_closes = !closesHand(now, env);
    env.hand_arrives = now.state.step + now.delay + 1;
  }

  [[nodiscard]] static bool isAnotherEpisode(const EnvState& state, const EnvPlan& env) {
    return state.step == 0 || state.begun != env.begun || state.episode != env.episode ||
           state.step < env.step;
  }

  /// Starts afresh: an episode has begun, or the policy meets one midway.
  void begin(const Situation& now, EnvPlan& env) const {
    env = {};
    if (lags_) env.asked = now.state.joint_positions;
    // At the beginning of an episode, no actions are under way.
    if (now.state.step == 0) env.waited = now.delay;
  }

  [[nodiscard]] bool isAtGoal(const EnvState& state) const {
    if (options_.task.kind != TaskKind::kRearrange || state.held >= 0) return false;
    const Vec3 away = state.objects[state.target].translation - state.goal.translation;
    return std::sqrt(dot(away, away)) < options_.task.success_distance;
  }

  void finish(EnvPlan& env) const {
    env.phase = ScriptedPhase::kFinish;
    scripted::Plan plan;
    plan.steps.push_back({scripted::PlanStep::Kind::kTerminate, {}, {}, {}});
    env.player = scripted::PlanPlayer(std::move(plan), decisions_);
  }

  static void giveUp(EnvPlan& env) { env.phase = ScriptedPhase::kGaveUp; }

  void use(EnvPlan& env, scripted::Plan plan) const {
    if (plan.trouble != ScriptedTrouble::kNone) {
      env.trouble = plan.trouble;
      giveUp(env);
      return;
    }
    env.stance = plan.stance;
    env.player = scripted::PlanPlayer(std::move(plan), decisions_);
  }

  /// The state that the next plan begins with: joints are where they were asked to be, or where
  /// they are if they could not get there.
  [[nodiscard]] static EnvState planned(const EnvState& state, const EnvPlan& env, bool is_done) {
    EnvState result = state;
    if (is_done && !env.asked.empty()) result.joint_positions = env.asked;
    return result;
  }

  /// Plans anew after a plan has been played to its end, or after the robot has failed to follow
  /// it.
  void planNext(const EnvState& state, EnvPlan& env, Progress progress, std::size_t thread) {
    const bool is_done = progress == Progress::kDone;
    const bool holds_target = state.held == static_cast<std::int32_t>(state.target);
    if (!is_done) env.trouble = ScriptedTrouble::kStuck;
    if (is_done && !holds_target && !isAtGoal(state)) env.trouble = ScriptedTrouble::kMissed;
    const bool has_picked = is_done && holds_target && env.phase == ScriptedPhase::kPick;
    // A base that has strayed has not tried the place where its plan ends.
    const bool lost_its_way = progress == Progress::kOff || progress == Progress::kAstray;
    if (!has_picked && !lost_its_way) env.failed.push_back(env.stance);
    ++env.plans;
    env.reaches = 0;
    plan(planned(state, env, is_done), env, thread);
  }

  /// Called when the base is near its planned place: the arm may be able to reach from where it is.
  /// Returns whether it can.
  bool reachFromHere(const EnvState& state, EnvPlan& env, std::size_t thread) {
    const bool places = env.phase == ScriptedPhase::kPlace;
    const std::int32_t needed = places ? static_cast<std::int32_t>(state.target) : kNothingHeld;
    // Others may have opened or closed the hand in the meantime.
    if (state.held != needed || env.reaches >= kMostReaches) return false;
    const EnvState from = planned(state, env, true);
    scripted::Planner& planner = this->planner(thread);
    const scripted::Attempt attempt{env.plans, env.failed};
    scripted::Plan plan = places ? planner.planPlaceFromHere(from, attempt, env.reaches)
                                 : planner.planPickFromHere(from, attempt, env.reaches);
    ++env.reaches;
    if (plan.trouble != ScriptedTrouble::kNone) return false;
    use(env, std::move(plan));
    return true;
  }

  /// Plans from the current state of the env.
  void plan(const EnvState& state, EnvPlan& env, std::size_t thread) {
    const bool holds_target = state.held == static_cast<std::int32_t>(state.target);
    const bool holds_another = state.held >= 0 && !holds_target;
    env.is_planned = true;
    if (holds_another) env.trouble = ScriptedTrouble::kMissed;
    if (isAtGoal(state)) {
      // Terminating again would change nothing: the simulation wants something else.
      env.phase == ScriptedPhase::kFinish ? giveUp(env) : finish(env);
    } else if (holds_another || env.plans >= most_plans_ ||
               (holds_target && options_.task.kind == TaskKind::kMobilePick)) {
      giveUp(env);
    } else if (holds_target) {
      env.phase = ScriptedPhase::kPlace;
      use(env, planner(thread).planPlace(state, {env.plans, env.failed}));
    } else {
      env.phase = ScriptedPhase::kPick;
      use(env, planner(thread).planPick(state, {env.plans, env.failed}));
    }
  }

  World world_;
  SimulationOptions options_;
  scripted::Decisions decisions_;
  scripted::Arm arm_;
  bool lags_ = false;
  std::uint32_t most_plans_ = kMostPlans;
  std::vector<EnvPlan> envs_;
  /// One per thread, made when the thread plans for the first time.
  std::vector<std::optional<scripted::Planner>> planners_;
  std::vector<std::exception_ptr> faults_;
  // Of the current call:
  const BatchSimulator* simulator_ = nullptr;
  std::span<float> actions_;
  std::span<const std::uint8_t> where_;
  std::atomic<std::size_t> next_{0};
  /// Must be the last member: its threads use the others.
  std::unique_ptr<detail::Workers> workers_;
};

Result<ScriptedPolicy> ScriptedPolicy::create(const World& world,
                                              const SimulationOptions& options) {
  RETURN_IF_ERROR(checkOptions(options));
  if (options.task.kind == TaskKind::kNone) {
    return fail(ErrorCode::kUnsupported, "scripted policy",
                "the task is none, which has nothing to plan for; use rearrange or mobile pick");
  }
  ASSIGN_OR_RETURN(const scripted::Decisions decisions,
                   scripted::decisionsBy(options.action, options.task));
  return ScriptedPolicy(std::make_unique<Impl>(world, options, decisions));
}

ScriptedPolicy::ScriptedPolicy(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ScriptedPolicy::~ScriptedPolicy() = default;
ScriptedPolicy::ScriptedPolicy(ScriptedPolicy&&) noexcept = default;
ScriptedPolicy& ScriptedPolicy::operator=(ScriptedPolicy&&) noexcept = default;

void ScriptedPolicy::act(const BatchSimulator& simulator, std::span<float> actions,
                         std::span<const std::uint8_t> where) {
  impl_->act(simulator, actions, where);
}

void ScriptedPolicy::expectLag(bool lags) { impl_->expectLag(lags); }

void ScriptedPolicy::allowPlans(std::uint32_t most) { impl_->allowPlans(most); }

ScriptedPhase ScriptedPolicy::phase(std::size_t env) const {
  return impl_->env("ScriptedPolicy::phase", env).phase;
}

ScriptedTrouble ScriptedPolicy::trouble(std::size_t env) const {
  return impl_->env("ScriptedPolicy::trouble", env).trouble;
}

}  // namespace galactic
