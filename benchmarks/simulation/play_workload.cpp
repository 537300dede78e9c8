// Plays the workload of batch_steps a fixed number of steps, for programs that watch it:
// count_instructions.sh.
//
//   play_workload WORLD random|forward|held ENVS STEPS [STEPS_BEFORE]
//
// It prints what became of the steps and the processor time of one, for runs in turns. So many
// steps go before, or a third of STEPS, so that robots that drive ahead have reached the walls.
// After 500, each env has begun anew once: what comes then is as it will always be.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <span>
#include <string>

#include "galactic/batch_simulator.h"
#include "galactic/world.h"
#include "published_workload.h"

namespace galactic::published_workload {

/// Of this thread.
double processorSeconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Player {
  BatchSimulator& simulator;
  Actions actions;
  Resets resets;
  std::size_t step = 0;

  void take() {
    const std::span<const float> batch = actions.batch(step, resets.last());
    simulator.step(batch, resets.at(step));
    ++step;
  }
};

/// What is watched: callgrind finds it by its name.
[[gnu::noinline]] void playMeasured(Player& player, std::size_t steps) {
  for (std::size_t n = 0; n < steps; ++n) player.take();
}

}  // namespace galactic::published_workload

int main(int count, char** arguments) {
  using galactic::BatchSimulator;
  using galactic::Result;
  using galactic::SimulationStatistics;
  using galactic::World;
  using galactic::published_workload::Actions;
  using galactic::published_workload::Load;
  using galactic::published_workload::optionsOf;
  using galactic::published_workload::Player;
  using galactic::published_workload::playMeasured;
  using galactic::published_workload::processorSeconds;
  using galactic::published_workload::Resets;
  if (count != 5 && count != 6) {
    std::fprintf(stderr, "play_workload WORLD random|forward|held ENVS STEPS [STEPS_BEFORE]\n");
    return 1;
  }
  const std::filesystem::path file(arguments[1]);
  const std::string name(arguments[2]);
  const Load load = name == "forward" ? Load::kForward
                    : name == "held"  ? Load::kHeld
                                      : Load::kRandom;
  const auto envs = static_cast<std::uint32_t>(std::strtoul(arguments[3], nullptr, 10));
  const std::size_t steps = std::strtoul(arguments[4], nullptr, 10);
  const std::size_t before = count == 6 ? std::strtoul(arguments[5], nullptr, 10) : (steps + 2) / 3;
  const Result<World> world = World::open(std::span(&file, 1));
  if (!world) {
    std::fprintf(stderr, "%s: %s\n", world.error().where.c_str(), world.error().message.c_str());
    return 2;
  }
  Result<BatchSimulator> simulator = BatchSimulator::create(*world, optionsOf(envs, false));
  if (!simulator) {
    std::fprintf(stderr, "%s\n", simulator.error().message.c_str());
    return 2;
  }
  Player player{*simulator, Actions(envs, simulator->actionCount(), load, before + steps),
                Resets(envs, world->episodes().episodes().size())};
  for (std::size_t n = 0; n < before; ++n) player.take();
  const SimulationStatistics from = simulator->statistics();
  const double started = processorSeconds();
  playMeasured(player, steps);
  const double seconds = processorSeconds() - started;
  const SimulationStatistics to = simulator->statistics();
  const auto taken = static_cast<double>(to.steps - from.steps);
  std::printf("%.0f env-steps, %.3f %% refused, %.2f %% slid, %.1f ns each\n", taken,
              100 * static_cast<double>(to.refused - from.refused) / taken,
              100 * static_cast<double>(to.slid - from.slid) / taken, 1e9 * seconds / taken);
  return 0;
}
