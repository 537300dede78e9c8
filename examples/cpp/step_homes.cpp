// Steps homes with actions and a reward of its own. Usage: step_homes WORLD
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/kinematics.h"
#include "galactic/world.h"

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: step_homes WORLD\n");
    return galactic::kExitUsage;
  }
  const auto world = orThrow(galactic::World::open(argv[1]));
  // The task of the world, but for its reward and its end, which come from here.
  galactic::SimulationOptions options = world.withTask();
  options.envs = 64;
  options.task.kind = galactic::TaskKind::kNone;
  options.task.most_steps = 0;
  auto simulator = orThrow(galactic::BatchSimulator::create(world, options));

  // A row of actions for each env: the joints, forward, turn, hand, terminate.
  const galactic::ActionLayout layout = simulator.actionLayout();
  std::vector<float> actions(simulator.envCount() * layout.count());
  for (std::size_t env = 0; env < simulator.envCount(); ++env) {
    actions[env * layout.count() + layout.forward()] = 1;
  }

  // The part of the observation that the reward is about: from the grip to the target, meters.
  const auto& parts = simulator.observationParts();
  const std::size_t target =
      std::ranges::find(parts, "grip_target", &galactic::ObservationPart::name)->first;
  const std::vector<std::byte> start = simulator.saveState();
  double reward = 0;
  for (int step = 0; step < 100; ++step) {
    simulator.step(actions);
    for (std::size_t env = 0; env < simulator.envCount(); ++env) {
      const float* row = simulator.observations().data() + env * simulator.observationSize();
      const galactic::Vec3 way{row[target], row[target + 1], row[target + 2]};
      if (dot(way, way) < 1) reward += 1;
    }
  }
  std::printf("reward %.0f\n", reward);

  // Where are the links and the objects of an env? World frame.
  const galactic::EnvState state = simulator.envState(0);
  const galactic::Robot& robot = world.robot();
  std::vector<galactic::Pose> world_from_link(robot.links().size());
  forwardKinematics(robot.links(), state.world_from_root, state.joint_positions, world_from_link);
  const galactic::Vec3& root = world_from_link[0].translation;
  std::printf("the robot is at %.2f, %.2f\n", static_cast<double>(root.x),
              static_cast<double>(root.z));
  const galactic::EnvObjects objects = simulator.envObjects(0);
  for (std::size_t n = 0; n < objects.objects.size(); ++n) {
    std::printf("%s is %.2f m high\n",
                std::string(world.objectOf(objects.present.placements[n]).name).c_str(),
                static_cast<double>(objects.objects[n].translation.y));
  }

  // Back to the start, bit for bit.
  orThrow(simulator.restoreState(start));

  // Or from a state of one's own: half a meter to the side, if the robot can be there.
  galactic::EnvState moved = simulator.envState(0);
  moved.world_from_root.translation.z += 0.5F;
  const std::vector<std::uint32_t> envs{0};
  const auto were_set = orThrow(simulator.setStates(envs, {&moved, 1}));
  std::printf("half a meter to the side is %s\n", were_set.front() != 0 ? "free" : "taken");
  return galactic::kExitOk;
} catch (const galactic::ErrorException& failure) {
  std::fprintf(stderr, "%s\n", failure.what());
  return static_cast<int>(failure.error().code);
}
