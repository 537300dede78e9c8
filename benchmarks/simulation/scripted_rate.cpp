// How often the scripted policy solves the episodes of a world, each played once: success rate,
// mean steps, and where it fails.
//
//   scripted_rate WORLD.pack [--first N] [--steps N] [--threads T] [--verbose] [--frames EPISODE
//   --every N]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/world.h"
#include "scripted/scripted_policy.h"

namespace {

using galactic::BatchSimulator;
using galactic::EnvState;
using galactic::Error;
using galactic::Result;
using galactic::ScriptedPhase;
using galactic::ScriptedPolicy;
using galactic::SimulationOptions;
using galactic::World;

struct Arguments {
  std::filesystem::path world;
  std::uint32_t first = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t steps = 500;
  std::uint32_t threads = 1;
  bool verbose = false;
  std::int64_t frames_of = -1;
  std::uint32_t every = 25;
};

struct Tally {
  std::uint32_t episodes = 0;
  std::uint32_t successes = 0;
  std::uint64_t success_steps = 0;
  std::map<std::string, std::uint32_t> ends;
  double planning_seconds = 0;
  std::uint64_t env_steps = 0;
};

std::string_view phaseName(ScriptedPhase phase) {
  switch (phase) {
    case ScriptedPhase::kPick:
      return "pick";
    case ScriptedPhase::kPlace:
      return "place";
    case ScriptedPhase::kFinish:
      return "finish";
    case ScriptedPhase::kGaveUp:
      return "gave up";
  }
  return "";
}

std::string textOf(const galactic::Pose& pose) {
  const galactic::Vec3& t = pose.translation;
  const galactic::Quat& q = pose.rotation;
  return fmt::format("{:.9g} {:.9g} {:.9g}  {:.9g} {:.9g} {:.9g} {:.9g}", t.x, t.y, t.z, q.w, q.x,
                     q.y, q.z);
}

/// A frame as text: poses as x y z, then w x y z of the rotation; joints as galactic-pack takes
/// them.
void printFrame(const World& world, const EnvState& state, ScriptedPhase phase) {
  fmt::print("frame {} {} episode {}\n", state.step, phaseName(phase), state.episode);
  fmt::print("  base {}\n  joints ", textOf(state.world_from_root));
  const galactic::Robot& robot = world.robot();
  // A joint that mimics another has no position of its own.
  std::vector<bool> is_printed(state.joint_positions.size());
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    const galactic::LinkFrame& frame = robot.links()[link];
    const bool is_plain = frame.multiplier == 1 && frame.offset == 0 && frame.position >= 0;
    if (!is_plain || positionCount(frame.type) != 1) continue;
    const auto position = static_cast<std::size_t>(frame.position);
    if (is_printed[position]) continue;
    is_printed[position] = true;
    fmt::print("{}={:.9g},", robot.jointName(link), state.joint_positions[position]);
  }
  fmt::print("\n  grip {}\n  held {}\n  goal {}\n", textOf(state.world_from_grip), state.held,
             textOf(state.goal));
  const auto placements = world.episodes().placements(world.episodes().episodes()[state.episode]);
  for (std::size_t n = 0; n < state.objects.size(); ++n) {
    fmt::print("  object {} {} {}{}\n", n, world.objectOf(placements[n]).name,
               textOf(state.objects[n]), n == state.target ? " target" : "");
  }
}

class Run {
 public:
  Run(const Arguments& arguments, const World& world, BatchSimulator simulator,
      ScriptedPolicy policy)
      : arguments_(arguments),
        world_(world),
        simulator_(std::move(simulator)),
        policy_(std::move(policy)),
        actions_(simulator_.envCount() * simulator_.actionCount()),
        is_over_(simulator_.envCount()),
        last_(simulator_.envCount()) {}

  Tally play() {
    for (std::uint32_t step = 0; step < arguments_.steps; ++step) {
      for (std::size_t env = 0; env < last_.size(); ++env) last_[env] = simulator_.envState(env);
      const auto before = std::chrono::steady_clock::now();
      policy_.act(simulator_, actions_);
      tally_.planning_seconds +=
          std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
      printFrames();
      simulator_.step(actions_);
      tally_.env_steps += last_.size();
      judge(step);
      if (tally_.episodes == last_.size()) break;
    }
    return tally_;
  }

 private:
  void printFrames() const {
    for (std::size_t env = 0; env < last_.size(); ++env) {
      const EnvState& state = last_[env];
      const bool is_wanted = static_cast<std::int64_t>(state.episode) == arguments_.frames_of &&
                             state.step % arguments_.every == 0 && is_over_[env] == 0;
      if (is_wanted) printFrame(world_, state, policy_.phase(env));
    }
  }

  void judge(std::uint32_t step) {
    for (std::size_t env = 0; env < last_.size(); ++env) {
      if (simulator_.dones()[env] == 0 || is_over_[env] != 0) continue;
      is_over_[env] = 1;
      ++tally_.episodes;
      const bool success = simulator_.successes()[env] != 0;
      if (success) {
        ++tally_.successes;
        tally_.success_steps += step + 1;
      }
      const std::string end = success ? "success"
                                      : fmt::format("{} ({})", phaseName(policy_.phase(env)),
                                                    nameOf(policy_.trouble(env)));
      ++tally_.ends[end];
      if (arguments_.verbose) {
        fmt::print("episode {:>4} {:>4} steps  {}\n", last_[env].episode, step + 1, end);
      }
    }
  }

  const Arguments& arguments_;
  const World& world_;
  BatchSimulator simulator_;
  ScriptedPolicy policy_;
  std::vector<float> actions_;
  std::vector<std::uint8_t> is_over_;
  std::vector<EnvState> last_;
  Tally tally_;
};

Result<Tally> run(const Arguments& arguments) {
  const Result<World> world = World::open(std::span(&arguments.world, 1));
  if (!world) return tl::unexpected<Error>(world.error());
  SimulationOptions options;
  options.threads = arguments.threads;
  options.order = galactic::EpisodeOrder::kPartition;
  const auto episodes = static_cast<std::uint32_t>(world->episodes().episodes().size());
  options.envs = std::min(episodes, arguments.first);
  // Env b takes episode b: all others are left to batches that do not run.
  options.ranks = (episodes + options.envs - 1) / options.envs;
  options.task.most_steps = arguments.steps;
  Result<BatchSimulator> simulator = BatchSimulator::create(*world, options);
  if (!simulator) return tl::unexpected<Error>(simulator.error());
  const std::size_t skipped = simulator->skippedEpisodes().size();
  if (skipped != 0) {
    // One env for each episode that can be started.
    options.envs -= static_cast<std::uint32_t>(skipped);
    simulator = BatchSimulator::create(*world, options);
    fmt::print("{} episodes cannot be started\n", skipped);
  }
  Result<ScriptedPolicy> policy = ScriptedPolicy::create(*world, options);
  if (!policy) return tl::unexpected<Error>(policy.error());
  return Run(arguments, *world, std::move(*simulator), std::move(*policy)).play();
}

void print(const Tally& tally) {
  fmt::print("episodes   {}\nsuccesses  {} ({:.1f} %)\n", tally.episodes, tally.successes,
             100.0 * tally.successes / tally.episodes);
  if (tally.successes != 0) {
    fmt::print("steps      {:.1f} on average of the successes\n",
               static_cast<double>(tally.success_steps) / tally.successes);
  }
  fmt::print("policy     {:.2f} s for {} env-steps: {:.0f} per second\n", tally.planning_seconds,
             tally.env_steps, static_cast<double>(tally.env_steps) / tally.planning_seconds);
  for (const auto& [end, count] : tally.ends) fmt::print("  {:>5}  {}\n", count, end);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("How often the scripted policy solves the episodes of a world.");
  app.add_option("world", arguments.world, "a world pack")->required();
  app.add_option("--first", arguments.first, "how many episodes; not given: all")
      ->check(CLI::PositiveNumber);
  app.add_option("--steps", arguments.steps, "steps of an episode")->capture_default_str();
  app.add_option("--threads", arguments.threads, "threads of the simulation");
  app.add_flag("--verbose", arguments.verbose, "one line for each episode");
  app.add_option("--frames", arguments.frames_of, "print frames of this episode");
  app.add_option("--every", arguments.every, "steps between frames")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  const Result<Tally> tally = run(arguments);
  if (!tally) {
    fmt::print(stderr, "scripted_rate: {}: {}\n", tally.error().where, tally.error().message);
    return static_cast<int>(tally.error().code);
  }
  print(*tally);
  return galactic::kExitOk;
}
