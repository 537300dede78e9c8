// The search of bullet_penetration_test.cpp for as long as one likes: docs/testing.md.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "penetration_run.h"

int main(int argc, char** argv) {
  galactic::test::PenetrationRun run{.watched = 8, .sampled = 16};
  std::uint64_t env_steps = 10'000'000;
  CLI::App app{"Looks for states of a simulation that penetrate something; 1 when it finds any."};
  app.add_option("scene", run.mesh, "Mesh of a scene, Y up")->required();
  app.add_option("episodes", run.episodes, "Published episodes in it (default: generated ones)");
  app.add_option("--env-steps", env_steps, "Steps of all envs together")->capture_default_str();
  app.add_option("--watched", run.watched, "Look at one env in so many")
      ->check(CLI::Range(1U, 512U))
      ->capture_default_str();
  app.add_option("--sampled", run.sampled, "Show Bullet one state of theirs in so many")
      ->check(CLI::Range(1U, 1U << 20U))
      ->capture_default_str();
  app.add_option("--seed", run.seed, "Of the actions")->capture_default_str();
  app.add_flag("--continuous-collision", run.continuous, "Look at moves on their way, too");
  CLI11_PARSE(app, argc, argv);
  run.steps = (env_steps + run.envs - 1) / run.envs;
  try {
    const auto report = searchPenetrations(run);
    print(report);
    const auto& found = report.found;
    const auto all = found.in_grid[0] + found.in_grid[1] + found.in_objects[0] +
                     found.in_objects[1] + found.in_scene[0] + found.in_scene[1];
    return all == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "penetration_search: %s\n", error.what());
    return 2;
  }
}
