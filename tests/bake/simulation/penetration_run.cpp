#include "penetration_run.h"

#include <algorithm>
#include <cstdio>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "home.h"
#include "support/oracles/distance_oracle.h"

namespace galactic::test {
namespace {

const SampleThings& things() {
  static const SampleThings baked;
  return baked;
}

/// Random actions; hands keep what they have for a while, and half of the envs drive ahead.
void drawActions(std::uint64_t step, std::size_t count, std::mt19937& random,
                 std::span<float> actions) {
  for (std::size_t env = 0; env * count < actions.size(); ++env) {
    const std::span<float> row = actions.subspan(env * count, count);
    for (float& action : row) action = uniformIn(random, -1, 1);
    float& forward = row[count - 4];
    if (env % 2 == 0) forward = 0.5F + 0.5F * forward;
    row[count - 2] = (step + env) % 150 < 110 ? 1.0F : -1.0F;
    row[count - 1] = 0;
  }
}

unsigned long long number(std::uint64_t value) { return value; }

void printMoves(const char* which, std::uint64_t tunneled, std::uint64_t swept) {
  const double share = static_cast<double>(tunneled) / std::max(1.0, static_cast<double>(swept));
  std::printf("%s %llu, through something thin %llu: %.2f of 100,000\n", which, number(swept),
              number(tunneled), 1e5 * share);
}

}  // namespace

PenetrationReport searchPenetrations(const PenetrationRun& run) {
  const Home home({run.mesh, run.episodes}, things());
  SimulationOptions options;
  options.envs = run.envs;
  options.threads = 2;
  options.body_transforms = true;
  options.continuous_collision = run.continuous;
  options.task.kind = TaskKind::kNone;
  options.task.most_steps = 200;
  auto simulator = MemoryPack::opened(BatchSimulator::create(home.world(), options));
  PenetrationReport report;
  report.episodes = home.world().episodes().episodes().size();
  report.skipped = simulator.skippedEpisodes().size();
  BulletScene scene(home.mesh());
  StateChecker checker(home.world(), simulator, scene);
  std::mt19937 random(run.seed);
  std::vector<float> actions(run.envs * simulator.actionCount());
  for (std::uint64_t step = 0; step < run.steps; ++step) {
    drawActions(step, simulator.actionCount(), random, actions);
    simulator.step(actions);
    for (std::uint32_t env = 0; env < run.envs; env += run.watched) {
      checker.check(env, (env / run.watched + step) % run.sampled == 0, report.found);
    }
  }
  report.seen = simulator.statistics();
  const DistanceOracle oracle(home.mesh(), 0.2);
  report.deepest_exactly = static_cast<double>(report.found.deepest_radius) -
                           oracle.distance(toPoint(report.found.deepest_center));
  return report;
}

void print(const PenetrationReport& report) {
  const Findings& found = report.found;
  const SimulationStatistics& seen = report.seen;
  std::printf("skipped %zu of %zu episodes\n", report.skipped, report.episodes);
  std::printf("states %llu: refused %llu, slid %llu, grasps %llu, drops %llu, restored %llu\n",
              number(found.states), number(seen.refused), number(seen.slid), number(seen.grasps),
              number(seen.drops), number(seen.restored));
  std::printf(
      "spheres: robot %llu, held %llu (excepted %llu), near objects %llu, shown to Bullet %llu "
      "(%llu touch)\n",
      number(found.robot_spheres), number(found.held_spheres), number(found.excepted),
      number(found.near_objects), number(found.exact), number(found.shallow));
  printMoves("moves shown to Bullet", found.tunneled, found.swept);
  printMoves("of those that did not slide", found.tunneled_straight, found.swept_straight);
  const Vec3& deepest = found.deepest_center;
  std::printf(
      "deepest in the scene: %.2f mm, exactly %.2f (allowed %.2f), a sphere of %g m at (%g, %g, "
      "%g)\n",
      1000 * static_cast<double>(found.deepest), 1000 * report.deepest_exactly,
      1000 * double{StateChecker::kDeepest}, static_cast<double>(found.deepest_radius),
      static_cast<double>(deepest.x), static_cast<double>(deepest.y),
      static_cast<double>(deepest.z));
  std::printf("spheres of robots that released an object into themselves: %llu\n",
              number(found.released_into));
  for (const std::string& note : found.notes) std::printf("%s\n", note.c_str());
  for (const std::size_t n : {0U, 1U}) {
    std::printf("%s: in the grid %llu, in objects %llu, deep in the scene %llu\n",
                n == 0 ? "robot" : "held", number(found.in_grid[n]), number(found.in_objects[n]),
                number(found.in_scene[n]));
  }
}

}  // namespace galactic::test
