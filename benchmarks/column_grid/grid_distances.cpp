// Nanoseconds per distance to what a column grid does not call free, by how far a query looks; what
// the blocks that spare it most cells take to make, and their bytes. GALACTIC_BENCH_PACKS names a
// folder of scene packs; without it the scenes are made up.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <exception>
#include <random>
#include <vector>

#include "column_grid/grid_distance.h"
#include "column_query_scenes.h"

namespace galactic::bench {
namespace {

using detail::Directions;
using detail::GridDistance;

constexpr std::uint32_t kSeed = 1;
constexpr std::size_t kQueries = 4096;

struct Query {
  const GridDistance* distance = nullptr;
  Vec3 center;
};

/// Up to 1.5 m above the lowest height, in free places, or in such as are not.
std::vector<Query> makeQueries(const std::deque<GridDistance>& distances,
                               const std::vector<const ColumnGrid*>& grids, Clearance clearance) {
  constexpr float kHeights = 1.5F;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> share(0, 1);
  std::vector<Query> queries;
  while (queries.size() < kQueries) {
    const std::size_t n = random() % grids.size();
    const ColumnGridLayout& layout = grids[n]->layout();
    const Vec3 center{
        layout.min_x + share(random) * static_cast<float>(layout.columns_x) * layout.spacing,
        layout.heights.lo + share(random) * kHeights,
        layout.min_z + share(random) * static_cast<float>(layout.columns_z) * layout.spacing};
    if (grids[n]->clearance(center) == clearance) queries.push_back({&distances[n], center});
  }
  return queries;
}

int run(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const char* folder = std::getenv("GALACTIC_BENCH_PACKS");
  const SceneSource source =
      folder == nullptr ? SceneSource::synthetic() : SceneSource::fromPacks(folder);
  std::vector<const ColumnGrid*> grids;
  std::deque<GridDistance> distances;
  std::size_t bytes = 0;
  for (const SceneGrids& scene : source.scenes()) {
    for (const ColumnGrid& grid : scene) {
      grids.push_back(&grid);
      bytes += distances.emplace_back(grid).bytes();
    }
  }
  benchmark::RegisterBenchmark("making the blocks of a grid", [&](benchmark::State& state) {
    std::size_t n = 0;
    for ([[maybe_unused]] auto _ : state) {
      benchmark::DoNotOptimize(GridDistance(*grids[n++ % grids.size()]));
    }
    state.counters["bytes"] = static_cast<double>(bytes) / static_cast<double>(grids.size());
  });
  const auto add = [](const std::string& name, const std::vector<Query>& queries, float most,
                      Directions directions) {
    benchmark::RegisterBenchmark(
        fmt::format("{}, {:g} m", name, most).c_str(),
        [&queries, most, directions](benchmark::State& state) {
          std::size_t n = 0;
          for ([[maybe_unused]] auto _ : state) {
            const Query& query = queries[n++ % kQueries];
            benchmark::DoNotOptimize(query.distance->at(query.center, most, directions));
          }
        });
  };
  const std::vector<Query> free = makeQueries(distances, grids, Clearance::kFree);
  const std::vector<Query> blocked = makeQueries(distances, grids, Clearance::kBlocked);
  for (const float most : {0.05F, 0.1F, 0.2F, 0.4F, 0.8F}) {
    add("free", free, most, Directions::kAll);
    add("free, level", free, most, Directions::kLevel);
    add("not free", blocked, most, Directions::kAll);
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace galactic::bench

int main(int argc, char** argv) {
  try {
    return galactic::bench::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "grid_distances: {}\n", error.what());
    return 1;
  }
}
