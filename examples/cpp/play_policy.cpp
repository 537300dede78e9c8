// Plays a policy pack in a world. Usage: play_policy WORLD POLICY
#include <cstdio>
#include <filesystem>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/learned_policy.h"
#include "galactic/option_text.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: play_policy WORLD POLICY\n");
    return galactic::kExitUsage;
  }
  const auto refuse = [](const galactic::Error& error) {
    std::fprintf(stderr, "%s: %s\n", error.where.c_str(), error.message.c_str());
    return static_cast<int>(error.code);
  };
  const std::vector<std::filesystem::path> packs{argv[1]};
  const auto world = galactic::World::open(packs);
  if (!world) return refuse(world.error());
  const auto pack = galactic::PackFile::open(argv[2]);
  if (!pack) return refuse(pack.error());
  const auto needs = galactic::policyInterface(*pack);
  if (!needs) return refuse(needs.error());
  // The options that the policy was trained with: its task, its sensors.
  galactic::SimulationOptions options = world->withTask();
  (void)setOptions(needs->options, galactic::OptionScope::kTask, options);
  auto simulator = galactic::BatchSimulator::create(*world, options);
  if (!simulator) return refuse(simulator.error());
  auto policy = galactic::LearnedPolicy::create(*pack, galactic::policyBatchOf(*simulator, *world),
                                                {.samples = true, .seed = 1});
  if (!policy) return refuse(policy.error());
  std::vector<float> actions(simulator->envCount() * simulator->actionCount());
  for (int step = 0; step < 100; ++step) {
    policy->act({.observations = simulator->observations(), .dones = simulator->dones()}, actions);
    simulator->step(actions);
  }
  std::printf("%zu envs, 100 steps\n", simulator->envCount());
  return galactic::kExitOk;
}
