// Plays a policy pack in a world. Usage: play_policy WORLD POLICY
#include <cstdio>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/learned_policy.h"
#include "galactic/option_text.h"

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "usage: play_policy WORLD POLICY\n");
    return galactic::kExitUsage;
  }
  const auto world = orThrow(galactic::World::open(argv[1]));
  const auto pack = orThrow(galactic::PackFile::open(argv[2]));
  const auto needs = orThrow(galactic::policyInterface(pack));
  if (needs.image) {
    std::fprintf(stderr, "the policy sees images: draw them for act(), as draw_views does\n");
    return static_cast<int>(galactic::ErrorCode::kUnsupported);
  }
  // The options that the policy was trained with: its task, its sensors.
  galactic::SimulationOptions options = world.withTask();
  if (const auto fault = setOptions(needs.options, galactic::OptionScope::kTask, options)) {
    const galactic::OptionText& option = needs.options[fault->index];
    std::fprintf(stderr, "%s: unknown option %s=%s\n", argv[2], option.name.c_str(),
                 option.value.c_str());
    return static_cast<int>(galactic::ErrorCode::kInvalidInput);
  }
  auto simulator = orThrow(galactic::BatchSimulator::create(world, options));
  auto policy = orThrow(galactic::LearnedPolicy::create(pack, galactic::policyBatchOf(simulator),
                                                        {.samples = true, .seed = 1}));
  std::vector<float> actions(simulator.envCount() * simulator.actionCount());
  for (int step = 0; step < 100; ++step) {
    policy.act({.observations = simulator.observations(), .dones = simulator.dones()}, actions);
    simulator.step(actions);
  }
  std::printf("%zu envs, 100 steps\n", simulator.envCount());
  return galactic::kExitOk;
} catch (const galactic::ErrorException& failure) {
  std::fprintf(stderr, "%s\n", failure.what());
  return static_cast<int>(failure.error().code);
}
