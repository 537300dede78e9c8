// Any bytes as actions, resets and states of a small batch. Nothing may become a number that is
// none, no robot may leave the room, and the books have to balance.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "finding.h"
#include "input.h"
#include "runtime/simulation/batch_trace.h"

namespace {

using galactic::BatchSimulator;
using galactic::EnvState;
using galactic::test::Input;
using galactic::test::reportFinding;

galactic::SimulationOptions optionsOf(Input& input) {
  const auto bits = input.take<std::uint8_t>();
  galactic::SimulationOptions options = galactic::test::optionsFor(3);
  options.slide.direction =
      (bits & 1U) != 0 ? galactic::SlideDirection::kTowardsBase : galactic::SlideDirection::kGlide;
  options.task.kind = static_cast<galactic::TaskKind>((bits >> 1U & 3U) % 3);
  options.task.drop_fails = (bits & 8U) != 0;
  options.task.needs_terminate = (bits & 16U) != 0;
  options.task.distractors = (bits & 32U) == 0;
  options.order =
      (bits & 64U) != 0 ? galactic::EpisodeOrder::kLinear : galactic::EpisodeOrder::kPartition;
  return options;
}

void checkFinite(std::span<const float> values, std::string_view finding) {
  for (const float value : values) {
    if (!std::isfinite(value)) reportFinding(finding);
  }
}

void checkEnv(const EnvState& state) {
  const galactic::Vec3& at = state.world_from_root.translation;
  if (!(at.x >= 0 && at.x <= 3 && at.z >= 0 && at.z <= 3))
    reportFinding("a robot outside the room");
  if (!(at.y >= -0.06F && at.y <= 0.06F)) reportFinding("a robot that is not on the floor");
  checkFinite(state.joint_positions, "a joint that is no number");
  if (state.held < -1 || state.held >= static_cast<std::int32_t>(state.objects.size())) {
    reportFinding("an object held that is not there");
  }
  for (const galactic::Pose& pose : state.objects) {
    const galactic::Quat& q = pose.rotation;
    const float length = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    if (!(std::abs(length - 1) < 1e-3F)) reportFinding("an object whose rotation is none");
    const galactic::Vec3& point = pose.translation;
    if (!std::isfinite(point.x + point.y + point.z)) reportFinding("an object that is nowhere");
  }
}

/// A number of a state as it is, moved a little, or any bits.
void change(float& number, Input& input) {
  const auto by = input.take<std::int8_t>();
  number = by == -128 ? input.take<float>() : number + 0.01F * static_cast<float>(by);
}

void change(galactic::Pose& pose, Input& input) {
  for (float* number : {&pose.translation.x, &pose.translation.y, &pose.translation.z}) {
    change(*number, input);
  }
  const auto& [x, y, z, w] = pose.rotation;
  switch (input.take<std::int8_t>()) {
    case 1:
      pose.rotation = {-z, w, x, -y};
      break;
    case 2:
      change(pose.rotation.w, input);
      break;
    default:
      break;
  }
}

/// Has env 0 go on from a changed state of any env, if that is one. Whether it does.
bool setState(BatchSimulator& simulator, Input& input) {
  EnvState state = simulator.envState(input.take<std::uint8_t>() % simulator.envCount());
  change(state.world_from_root, input);
  change(state.world_from_grip, input);
  change(state.goal, input);
  for (float& position : state.joint_positions) change(position, input);
  for (galactic::Pose& object : state.objects) change(object, input);
  state.held = static_cast<std::int32_t>(input.take<std::int8_t>() % 4);
  const auto set = simulator.setStates(std::array{0U}, std::array{state});
  return set && set->front() != 0;
}

/// `given`: objects that states put into hands, at most.
void checkBatch(const BatchSimulator& simulator, std::uint64_t given) {
  checkFinite(simulator.observations(), "an observation that is no number");
  checkFinite(simulator.rewards(), "a reward that is no number");
  for (std::size_t env = 0; env < simulator.envCount(); ++env) {
    checkEnv(simulator.envState(env));
    if (simulator.successes()[env] > simulator.dones()[env])
      reportFinding("a success that is no end");
    if (simulator.picks()[env] > simulator.dones()[env]) reportFinding("a pick that is no end's");
    const galactic::EpisodeEnd end = simulator.endings()[env];
    const bool says_done = galactic::isTermination(end) || galactic::isTruncation(end);
    if (says_done != (simulator.dones()[env] != 0)) reportFinding("an end without a reason");
  }
  const galactic::SimulationStatistics seen = simulator.statistics();
  if (seen.refused + seen.slid > seen.steps) reportFinding("more steps refused and slid than done");
  if (seen.drops + seen.restored > seen.grasps + given) reportFinding("more released than grasped");
  if (seen.successes + seen.failures > seen.episodes) reportFinding("more ends than episodes");
  if (seen.picks > seen.episodes) reportFinding("more picks than episodes");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const galactic::test::BoxWorld world = galactic::test::furnishedWorld();
  Input input({data, size});
  auto simulator = BatchSimulator::create(world.world(), optionsOf(input));
  if (!simulator) reportFinding(simulator.error().message);
  std::vector<float> actions(simulator->envCount() * simulator->actionCount());
  std::vector<std::int32_t> resets(simulator->envCount());
  std::uint64_t given = 0;
  constexpr int kMostSteps = 400;
  for (int step = 0; step < kMostSteps && !input.isEmpty(); ++step) {
    for (float& action : actions) action = input.action();
    const auto chosen = input.take<std::int8_t>();
    for (std::int32_t& reset : resets) reset = chosen > 100 ? input.take<std::int32_t>() : -1;
    simulator->step(actions, resets);
    if (chosen < -120) given += setState(*simulator, input) ? 1U : 0U;
    checkBatch(*simulator, given);
  }
  return 0;
}
