#include "inspect/query_benchmark.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <vector>

#include "support/text/counted.h"

namespace galactic {
namespace {

using Seconds = std::chrono::duration<double>;

/// Room for the answers of the longest group, reused for each group.
struct Answers {
  explicit Answers(std::size_t count) : clearance(count), down(count), up(count) {}

  std::vector<Clearance> clearance;
  std::vector<float> down, up;
};

void askBatched(const ColumnGrid& grid, const SphereCenters& centers, Answers& answers) {
  const std::size_t count = centers.x.size();
  grid.contact(centers, {std::span(answers.clearance).first(count),
                         std::span(answers.down).first(count), std::span(answers.up).first(count)});
}

void askOneByOne(const ColumnGrid& grid, const SphereCenters& centers, Answers& answers) {
  for (std::size_t n = 0; n < centers.x.size(); ++n) {
    const Contact contact = grid.contact({centers.x[n], centers.y[n], centers.z[n]});
    answers.clearance[n] = contact.clearance;
    answers.down[n] = contact.down;
    answers.up[n] = contact.up;
  }
}

/// Seconds of the fastest of several passes: other load on the machine slowed the others down.
template <class Ask>
double measure(std::span<const SceneGrids> scenes, const QueryWorkload& workload, Ask ask) {
  constexpr int kPasses = 7;
  Answers answers(workload.longest);
  double best = std::numeric_limits<double>::max();
  for (int pass = 0; pass < kPasses; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    for (const QueryGroup& group : workload.groups) {
      ask(scenes[group.scene][group.grid], workload.centers(group), answers);
    }
    const Seconds seconds = std::chrono::steady_clock::now() - start;
    best = std::min(best, seconds.count());
  }
  return best;
}

/// How many of the queries find a free place; separate from the measurement, since counting takes
/// time, too.
std::size_t countFree(std::span<const SceneGrids> scenes, const QueryWorkload& workload) {
  Answers answers(workload.longest);
  std::ptrdiff_t free = 0;
  for (const QueryGroup& group : workload.groups) {
    askBatched(scenes[group.scene][group.grid], workload.centers(group), answers);
    const auto asked = std::span(answers.clearance).first(group.count);
    free += std::count(asked.begin(), asked.end(), Clearance::kFree);
  }
  return static_cast<std::size_t>(free);
}

}  // namespace

std::string runQueryBenchmark(std::span<const SceneGrids> scenes, std::uint32_t seed) {
  constexpr double kNanoseconds = 1e9;
  std::string table =
      fmt::format("query benchmark, one thread, {}, seed {}\n{:<24}{:>12}{:>9}{:>14}{:>14}\n",
                  counted(scenes.size(), "scene"), seed, "workload", "queries", "free", "batched",
                  "one by one");
  const QueryWorkload workloads[] = {coherentWorkload(scenes, 128, 200, seed),
                                     coherentWorkload(scenes, 1024, 40, seed),
                                     randomWorkload(scenes, 1U << 17U, seed)};
  for (const QueryWorkload& workload : workloads) {
    const auto free = static_cast<double>(countFree(scenes, workload));
    const double batched = measure(scenes, workload, askBatched);
    const double scalar = measure(scenes, workload, askOneByOne);
    const auto queries = static_cast<double>(workload.x.size());
    table += fmt::format("{:<24}{:>12}{:>7.1f} %{:>11.2f} ns{:>11.2f} ns\n", workload.name,
                         workload.x.size(), 100 * free / queries, batched * kNanoseconds / queries,
                         scalar * kNanoseconds / queries);
  }
  return table;
}

}  // namespace galactic
