#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"

namespace galactic::test {

// The task as the paper's appendix A has it, in double precision and from EnvState alone: what an
// onlooker sees before and after a step. Shares nothing with the simulation's task.

using Double3 = std::array<double, 3>;

inline Double3 double3(const Vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

inline Double3 difference(const Double3& a, const Double3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline double distance(const Vec3& a, const Vec3& b) {
  const Double3 away = difference(double3(a), double3(b));
  return std::sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]);
}

/// `v` in the frame whose axes in the world are the columns of the rotation `q`.
inline Double3 turnedInto(const Quat& q, const Double3& v) {
  const double x = static_cast<double>(q.x);
  const double y = static_cast<double>(q.y);
  const double z = static_cast<double>(q.z);
  const double w = static_cast<double>(q.w);
  const std::array<Double3, 3> axes{
      {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
       {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
       {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}}};
  Double3 result{};
  for (std::size_t n = 0; n < 3; ++n) {
    for (std::size_t m = 0; m < 3; ++m) result[n] += axes[n][m] * v[m];
  }
  return result;
}

/// What a step deserves.
struct Judgement {
  double reward = 0;
  bool done = false;
  bool success = false;
  bool failure = false;
  EpisodeEnd end = EpisodeEnd::kNone;
};

/// One env's episode.
class TaskOracle {
 public:
  TaskOracle(const TaskOptions& task, const ActionOptions& actions)
      : task_(task), actions_(actions) {}

  void begin() {
    has_picked_ = false;
    last_joints_.clear();
    steps_ = 0;
  }

  /// `row`: the actions as given to the simulator, four of them behind the joints'.
  [[nodiscard]] Judgement judge(const EnvState& before, const EnvState& after,
                                std::span<const float> row) {
    ++steps_;
    if (steps_ == 1) up_ = upOf(before);
    const auto target = static_cast<std::int32_t>(after.target);
    const bool picks = after.held == target && before.held != target && !has_picked_;
    has_picked_ = has_picked_ || picks;
    Judgement result = outcome(before, after, valueOf(row.back()));
    const double change = actionChange(row);
    if (task_.kind == TaskKind::kNone) return result;
    const auto weight = [](float w) { return static_cast<double>(w); };
    result.reward = weight(task_.reach_weight) * (reachOf(before) - reachOf(after)) +
                    weight(task_.transport_weight) * (transportOf(before) - transportOf(after)) -
                    weight(task_.action_weight) * change - weight(task_.slack_penalty);
    if (picks) result.reward += weight(task_.pick_reward);
    if (after.held == target) result.reward -= weight(task_.tilt_penalty) * (1 - tiltCosine(after));
    if (result.success) result.reward += weight(task_.success_reward);
    if (result.failure) result.reward -= weight(task_.failure_penalty);
    return result;
  }

  /// Whether the target has been in the hand in this episode.
  [[nodiscard]] bool hasPicked() const { return has_picked_; }

  [[nodiscard]] static double reachOf(const EnvState& s) {
    return distance(s.world_from_grip.translation, s.objects[s.target].translation);
  }
  [[nodiscard]] static double transportOf(const EnvState& s) {
    return distance(s.objects[s.target].translation, s.goal.translation);
  }

 private:
  /// The world's up in the frame of the target.
  static Double3 upOf(const EnvState& s) {
    return turnedInto(s.objects[s.target].rotation, {0, 1, 0});
  }

  /// Of the angle by which the target is tilted since the episode began.
  [[nodiscard]] double tiltCosine(const EnvState& s) const {
    const Double3 up = upOf(s);
    return up[0] * up_[0] + up[1] * up_[1] + up[2] * up_[2];
  }

  static float valueOf(float action) {
    return std::isnan(action) ? 0.0F : std::fmin(std::fmax(action, -1.0F), 1.0F);
  }

  /// Ends the episode as the rules say.
  [[nodiscard]] Judgement outcome(const EnvState& before, const EnvState& after,
                                  float terminate) const {
    const auto target = static_cast<std::int32_t>(after.target);
    const bool near = transportOf(after) < static_cast<double>(task_.success_distance);
    const bool released = before.held == target && after.held < 0;
    const bool holds_another = after.held >= 0 && after.held != target;
    const bool late = task_.most_steps != 0 && steps_ >= task_.most_steps;
    // All that is true of the step, in the order in which it counts.
    std::vector<std::pair<bool, EpisodeEnd>> reasons;
    if (task_.kind == TaskKind::kMobilePick) {
      reasons = {{after.held == target, EpisodeEnd::kSuccess},
                 {task_.drop_fails && holds_another, EpisodeEnd::kWrongObject}};
    } else if (task_.kind == TaskKind::kRearrange) {
      const bool says_so = terminate >= actions_.terminate;
      const bool is_asked = task_.needs_terminate ? says_so : released;
      reasons = {{is_asked && near && after.held != target, EpisodeEnd::kSuccess},
                 {task_.needs_terminate && says_so, EpisodeEnd::kWrongTerminate},
                 {task_.drop_fails && released && !near, EpisodeEnd::kWrongRelease},
                 {task_.drop_fails && holds_another, EpisodeEnd::kWrongObject}};
    }
    reasons.emplace_back(late, EpisodeEnd::kTimeOut);
    for (const auto& [holds, end] : reasons) {
      if (!holds) continue;
      const bool success = end == EpisodeEnd::kSuccess;
      return {.done = true,
              .success = success,
              .failure = !success && end != EpisodeEnd::kTimeOut,
              .end = end};
    }
    return {};
  }

  [[nodiscard]] double actionChange(std::span<const float> row) {
    constexpr std::size_t kOthers = 4;
    std::vector<double> joints;
    for (const float action : row.first(row.size() - kOthers)) {
      joints.push_back(static_cast<double>(valueOf(action)));
    }
    double sum = 0;
    for (std::size_t n = 0; n < last_joints_.size(); ++n) {
      sum += (joints[n] - last_joints_[n]) * (joints[n] - last_joints_[n]);
    }
    last_joints_ = joints;
    return sum;
  }

  TaskOptions task_;
  ActionOptions actions_;
  bool has_picked_ = false;
  /// Empty before the first step of an episode.
  std::vector<double> last_joints_;
  std::uint32_t steps_ = 0;
  Double3 up_{};
};

/// The observation of an env in this state, part by part.
inline std::vector<double> observationOf(const World& world, const TaskOptions& task,
                                         const EnvState& s) {
  const Episode& episode = world.episodes().episodes()[s.episode];
  const Pose& at_start = world.episodes().placements(episode)[episode.target].pose;
  const Double3 target = double3(task.observes_current_target ? s.objects[s.target].translation
                                                              : at_start.translation);
  const Double3 goal = double3(s.goal.translation);
  const Double3 grip = double3(s.world_from_grip.translation);
  Double3 base = double3(s.world_from_root.translation);
  base[1] -= static_cast<double>(world.robot().base()->root_height);
  std::vector<double> row;
  const auto add = [&row](const Double3& v) { row.insert(row.end(), v.begin(), v.end()); };
  const auto in_base = [&](const Double3& p) {
    return turnedInto(s.world_from_root.rotation, difference(p, base));
  };
  const auto in_grip = [&](const Double3& p) {
    return turnedInto(s.world_from_grip.rotation, difference(p, grip));
  };
  add(in_base(target));
  add(in_grip(target));
  add(in_base(grip));
  add(in_base(goal));
  add(in_grip(goal));
  row.push_back(s.held >= 0 ? 1 : 0);
  for (const ControlledJoint& joint : world.robot().controlledJoints()) {
    row.push_back(static_cast<double>(s.joint_positions[joint.position]));
  }
  const double left = task.most_steps == 0 ? 1 : 1 - static_cast<double>(s.step) / task.most_steps;
  for (const double scale : {1.0, 5.0, 50.0}) row.push_back(std::min(1.0, scale * left));
  return row;
}

}  // namespace galactic::test
