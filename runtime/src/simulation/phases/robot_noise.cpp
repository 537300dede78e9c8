#include "simulation/phases/robot_noise.h"

#include <cmath>

#include "simulation/phases/action_delay.h"
#include "simulation/state/env_moment.h"
#include "simulation/state/episode_draws.h"
#include "support/random_stream.h"

namespace galactic::simulation {
namespace {

// Salts that separate these random numbers from each other, and from those of sensors.
constexpr std::uint64_t kMotionSalt = 0x4D6F74696F6E2D31ULL;
constexpr std::uint64_t kBiasSalt = 0x426961732D2D3031ULL;
constexpr std::uint64_t kOdometrySalt = 0x4F646F6D2D2D3031ULL;

/// The random numbers of a moment.
RandomStream luckOf(const EnvMoment& moment, std::uint64_t salt) {
  return {moment.seed ^ salt, moment.env, moment.episode, moment.step};
}

/// The random numbers of a moment's whole episode.
RandomStream lastingLuckOf(const EnvMoment& moment, std::uint64_t salt) {
  return {moment.seed ^ salt, moment.env, moment.episode, 0};
}

/// The relative errors of motions, one after another.
class Errors {
 public:
  Errors(float deviation, const RandomStream& random) : deviation_(deviation), random_(random) {}

  float next() { return deviation_ > 0 ? deviation_ * random_.nearlyNormal() : 0; }

 private:
  float deviation_;
  RandomStream random_;
};

/// Applies noise to the motions of one env.
void disturb(const ChunkStep& step, std::size_t e) {
  const RobotNoise& noise = step.model.options.noise;
  const EnvMoment moment = momentOf(step.model, step.state, step.first + e);
  Errors fleeting(drawnIn(moment, noise.motion, kMotionDraw), luckOf(moment, kMotionSalt));
  Errors lasting(drawnIn(moment, noise.motion_bias, kBiasDraw), lastingLuckOf(moment, kBiasSalt));
  const std::span<const EnvRow> asked = arrivedOf(step);
  const std::span<EnvRow> motions = step.chunk.motions();
  for (std::size_t m = 0; m < motions.size(); ++m) {
    motions[m].values[e] = asked[m].values[e] * (1 + fleeting.next() + lasting.next());
  }
  // Unequal wheels turn a driving base to one side or the other.
  const float drift = fleeting.next() + lasting.next();
  const ActionLayout layout = step.model.actionLayout();
  float drive = asked[layout.forward()].values[e];
  if (layout.drives_sideways) {
    const RobotBase& base = step.model.motion.base;
    drive += asked[layout.sideways()].values[e] * base.sideways_step / base.forward_step;
  }
  motions[layout.turn()].values[e] += drive * drift;
}

/// Turns a vector along the floor.
Vec3 turned(const Vec3& way, float angle) {
  const auto cosine = static_cast<float>(std::cos(static_cast<double>(angle)));
  const auto sine = static_cast<float>(std::sin(static_cast<double>(angle)));
  return {cosine * way.x + sine * way.z, 0, cosine * way.z - sine * way.x};
}

}  // namespace

std::span<const EnvRow> motionsOf(const ChunkStep& step) noexcept {
  if (!step.model.options.noise.changesMotion()) return arrivedOf(step);
  for (std::size_t e = 0; e < kChunk; ++e) disturb(step, e);
  return step.chunk.motions();
}

void beginOdometry(const Model& model, BatchState& state, std::size_t n) noexcept {
  if (!model.hasOdometry()) return;
  const PlanarPose known = state.planarPose(n);
  state.setOdometry(n, {known, known});
}

void followOdometry(const ChunkStep& step) noexcept {
  if (!step.model.hasOdometry()) return;
  const RobotBase& steps = step.model.motion.base;
  for (std::size_t n = step.first; n < step.first + kChunk; ++n) {
    const auto [was, believed] = step.state.odometry(n);
    const PlanarPose now = step.state.planarPose(n);
    const Vec3 way{now.x - was.x, 0, now.z - was.z};
    const float turn = wrappedAngle(now.yaw - was.yaw);
    const float length = std::sqrt(dot(way, way));
    if (length == 0 && turn == 0) continue;
    const EnvMoment moment = momentOf(step.model, step.state, n);
    Errors errors(drawnIn(moment, step.model.options.noise.localization, kLocalizationDraw),
                  luckOf(moment, kOdometrySalt));
    // Perceived motions have the same kind of errors as the motions themselves: see disturb().
    const float felt_turn = turn * (1 + errors.next());
    const float drift = length / steps.forward_step * steps.turn_step * errors.next();
    const float yaw = wrappedAngle(believed.yaw + felt_turn + drift);
    const Vec3 felt_way = turned(way, yaw - now.yaw) * (1 + errors.next());
    step.state.setOdometry(n, {now, {believed.x + felt_way.x, believed.z + felt_way.z, yaw}});
  }
}

void displace(const BatchState& state, std::size_t first, PointRows& points) noexcept {
  auto& [x, y, z] = points;
  for (std::size_t e = 0; e < kChunk; ++e) {
    const auto [is, believed] = state.odometry(first + e);
    const Vec3 away{x.values[e] - believed.x, 0, z.values[e] - believed.z};
    const Vec3 seen = turned(away, is.yaw - believed.yaw);
    x.values[e] = is.x + seen.x;
    z.values[e] = is.z + seen.z;
  }
}

}  // namespace galactic::simulation
