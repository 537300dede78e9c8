// Nanoseconds per ray through a column grid: from cell to cell, against marching in steps of a
// third of a cell. GALACTIC_BENCH_PACKS names a folder of scene packs; without it the scenes are
// made up.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numbers>
#include <random>
#include <vector>

#include "column_grid/free_way.h"
#include "column_query_scenes.h"

namespace galactic::bench {
namespace {

using detail::StraightLine;

constexpr std::uint32_t kSeed = 1;
constexpr double kRange = 10;
constexpr std::size_t kRays = 4096;

struct Ray {
  const ColumnGrid* grid = nullptr;
  StraightLine line;
};

/// From free places of the smallest spheres, in all directions alike.
std::vector<Ray> makeRays(const SceneSource& source) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> share(0, 1);
  std::vector<Ray> rays;
  while (rays.size() < kRays) {
    const ColumnGrid& grid = source.scenes()[random() % source.scenes().size()].front();
    const ColumnGridLayout& layout = grid.layout();
    const Vec3 from{
        layout.min_x + share(random) * static_cast<float>(layout.columns_x) * layout.spacing,
        layout.heights.lo + share(random) * (layout.heights.hi - layout.heights.lo),
        layout.min_z + share(random) * static_cast<float>(layout.columns_z) * layout.spacing};
    const double up = 2 * static_cast<double>(share(random)) - 1;
    const double level = std::sqrt(1 - up * up);
    const double azimuth = 2 * std::numbers::pi * static_cast<double>(share(random));
    if (grid.clearance(from) != Clearance::kFree) continue;
    rays.push_back(
        {&grid, {from, {level * std::cos(azimuth), up, level * std::sin(azimuth)}, kRange}});
  }
  return rays;
}

double goFromCellToCell(const Ray& ray) { return freeWay(*ray.grid, ray.line).length; }

double march(const Ray& ray) {
  const auto along = [&](std::size_t axis) { return static_cast<float>(ray.line.along[axis]); };
  const float step = ray.grid->spacing() / 3;
  float way = 0;
  while (way < static_cast<float>(kRange)) {
    const Vec3 at = ray.line.from + Vec3{along(0), along(1), along(2)} * way;
    if (ray.grid->clearance(at) != Clearance::kFree) break;
    way += step;
  }
  return static_cast<double>(way);
}

int run(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const char* folder = std::getenv("GALACTIC_BENCH_PACKS");
  const SceneSource source =
      folder == nullptr ? SceneSource::synthetic() : SceneSource::fromPacks(folder);
  const std::vector<Ray> rays = makeRays(source);
  const auto add = [&](const char* name, double (*cast)(const Ray&)) {
    benchmark::RegisterBenchmark(name, [&rays, cast](benchmark::State& state) {
      std::size_t n = 0;
      double meters = 0;
      for ([[maybe_unused]] auto _ : state) {
        const double way = cast(rays[n++ % kRays]);
        benchmark::DoNotOptimize(way);
        meters += way;
      }
      state.counters["meters"] = benchmark::Counter(meters, benchmark::Counter::kAvgIterations);
    });
  };
  add("from cell to cell", goFromCellToCell);
  add("marching", march);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace galactic::bench

int main(int argc, char** argv) {
  try {
    return galactic::bench::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "ray_casts: {}\n", error.what());
    return 1;
  }
}
