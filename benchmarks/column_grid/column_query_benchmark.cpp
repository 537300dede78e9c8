// Queries on the grids of 105 scenes: the published dense layout against ours, in one run.
// GALACTIC_BENCH_PACKS names a folder of scene packs; without it the scenes are made up.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "column_query_arena.h"
#include "column_query_dense.h"
#include "column_query_scenes.h"
#include "inspect/query_workload.h"

namespace galactic::bench {
namespace {

/// As many scenes as ReplicaCAD has.
constexpr std::size_t kScenes = 105;
constexpr std::uint32_t kSeed = 1;

enum class Method { kDense, kScalar, kBatched, kBatchedClearance };

const char* nameOf(Method method) {
  switch (method) {
    case Method::kDense:
      return "published dense";
    case Method::kScalar:
      return "ours one by one";
    case Method::kBatched:
      return "ours batched";
    case Method::kBatchedClearance:
      return "ours batched, clearance only";
  }
  return "";
}

/// Both layouts of all scenes, each in an arena of its own.
class Layouts {
 public:
  Layouts(const std::vector<SceneGrids>& source, Pages pages)
      : pages_(pages),
        ours_arena_(sizeOf(source, gridBytes), pages),
        dense_arena_(sizeOf(source, DenseGrid::bytes), pages) {
    for (std::size_t n = 0; n < kScenes; ++n) {
      SceneGrids grids;
      std::vector<DenseGrid> dense;
      for (const ColumnGrid& grid : source[n % source.size()]) {
        grids.push_back(copyGrid(grid, ours_arena_));
        dense.emplace_back(grid, dense_arena_);
      }
      ours_.push_back(std::move(grids));
      dense_.push_back(std::move(dense));
    }
  }

  [[nodiscard]] Pages pages() const { return pages_; }
  [[nodiscard]] const std::vector<SceneGrids>& ours() const { return ours_; }
  [[nodiscard]] const DenseGrid& dense(const QueryGroup& group) const {
    return dense_[group.scene][group.grid];
  }
  [[nodiscard]] std::size_t bytes(Method method) const {
    return method == Method::kDense ? dense_arena_.used() : ours_arena_.used();
  }

 private:
  template <class Bytes>
  static std::size_t sizeOf(const std::vector<SceneGrids>& source, Bytes bytes) {
    std::size_t sum = 0;
    for (std::size_t n = 0; n < kScenes; ++n) {
      for (const ColumnGrid& grid : source[n % source.size()]) sum += bytes(grid);
    }
    return sum;
  }

  Pages pages_;
  Arena ours_arena_;
  Arena dense_arena_;
  std::vector<SceneGrids> ours_;
  std::vector<std::vector<DenseGrid>> dense_;
};

/// Builds the layouts for the kind of pages that is asked for, one kind at a time: both together
/// would double the memory.
class LayoutsOnDemand {
 public:
  explicit LayoutsOnDemand(const std::vector<SceneGrids>& source) : source_(source) {}

  const Layouts& get(Pages pages) {
    if (!layouts_ || layouts_->pages() != pages) {
      layouts_.reset();
      layouts_ = std::make_unique<Layouts>(source_, pages);
    }
    return *layouts_;
  }

 private:
  const std::vector<SceneGrids>& source_;
  std::unique_ptr<Layouts> layouts_;
};

/// Answers of one group, and the layer that each sphere was found in last.
struct Scratch {
  explicit Scratch(const QueryWorkload& workload)
      : clearance(workload.longest),
        down(workload.longest),
        up(workload.longest),
        layers(workload.spheres == 0 ? workload.longest : workload.spheres) {}

  std::vector<Clearance> clearance;
  std::vector<float> down, up;
  std::vector<std::int8_t> layers;
};

void askDense(const Layouts& layouts, const QueryWorkload& workload, Scratch& scratch) {
  std::size_t sphere = 0;
  for (const QueryGroup& group : workload.groups) {
    const DenseGrid& grid = layouts.dense(group);
    for (std::size_t n = 0; n < group.count; ++n) {
      const std::size_t query = group.first + n;
      scratch.down[n] = grid.distanceDown({workload.x[query], workload.y[query], workload.z[query]},
                                          scratch.layers[sphere]);
      if (++sphere == scratch.layers.size()) sphere = 0;
    }
    benchmark::DoNotOptimize(scratch.down.data());
    benchmark::ClobberMemory();
  }
}

void askOneByOne(const Layouts& layouts, const QueryWorkload& workload, Scratch& scratch) {
  for (const QueryGroup& group : workload.groups) {
    const ColumnGrid& grid = layouts.ours()[group.scene][group.grid];
    for (std::size_t n = 0; n < group.count; ++n) {
      const std::size_t query = group.first + n;
      const Contact contact =
          grid.contact({workload.x[query], workload.y[query], workload.z[query]});
      scratch.clearance[n] = contact.clearance;
      scratch.down[n] = contact.down;
      scratch.up[n] = contact.up;
    }
    benchmark::DoNotOptimize(scratch.down.data());
    benchmark::ClobberMemory();
  }
}

void askBatched(const Layouts& layouts, const QueryWorkload& workload, bool distances,
                Scratch& scratch) {
  for (const QueryGroup& group : workload.groups) {
    const std::size_t wanted = distances ? group.count : 0;
    layouts.ours()[group.scene][group.grid].contact(
        workload.centers(group),
        {std::span(scratch.clearance).first(group.count), std::span(scratch.down).first(wanted),
         std::span(scratch.up).first(wanted)});
    benchmark::DoNotOptimize(scratch.clearance.data());
    benchmark::ClobberMemory();
  }
}

void ask(Method method, const Layouts& layouts, const QueryWorkload& workload, Scratch& scratch) {
  switch (method) {
    case Method::kDense:
      return askDense(layouts, workload, scratch);
    case Method::kScalar:
      return askOneByOne(layouts, workload, scratch);
    case Method::kBatched:
      return askBatched(layouts, workload, true, scratch);
    case Method::kBatchedClearance:
      return askBatched(layouts, workload, false, scratch);
  }
}

void measure(benchmark::State& state, Method method, const Layouts& layouts,
             const QueryWorkload& workload) {
  Scratch scratch(workload);
  for (auto iteration : state) {
    static_cast<void>(iteration);
    ask(method, layouts, workload, scratch);
  }
  state.counters["per_query"] = benchmark::Counter(
      static_cast<double>(workload.x.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["bytes"] = static_cast<double>(layouts.bytes(method));
}

/// The workloads on 105 scenes; a scene that is there several times has several copies to visit.
std::array<QueryWorkload, 3> makeWorkloads(const std::vector<SceneGrids>& source) {
  std::vector<SceneGrids> scenes;
  for (std::size_t n = 0; n < kScenes; ++n) scenes.push_back(source[n % source.size()]);
  return {coherentWorkload(scenes, 128, 400, kSeed), coherentWorkload(scenes, 1024, 60, kSeed),
          randomWorkload(scenes, 250'000, kSeed)};
}

int run(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  const char* folder = std::getenv("GALACTIC_BENCH_PACKS");
  const SceneSource source =
      folder == nullptr ? SceneSource::synthetic() : SceneSource::fromPacks(folder);
  fmt::print(stderr, "{}, {}; measured on {} scenes, seed {}\n",
             folder == nullptr ? "made-up scenes (set GALACTIC_BENCH_PACKS for others)" : folder,
             describe(source.scenes()), kScenes, kSeed);
  const std::array<QueryWorkload, 3> workloads = makeWorkloads(source.scenes());
  LayoutsOnDemand layouts(source.scenes());
  for (const Pages pages : {Pages::kHuge, Pages::kSmall}) {
    for (const QueryWorkload& workload : workloads) {
      for (const Method method :
           {Method::kDense, Method::kScalar, Method::kBatched, Method::kBatchedClearance}) {
        const std::string name = fmt::format("{}/{}/{}", workload.name, nameOf(method),
                                             pages == Pages::kHuge ? "huge pages" : "small pages");
        benchmark::RegisterBenchmark(name.c_str(), [&, method, pages](benchmark::State& state) {
          measure(state, method, layouts.get(pages), workload);
        })->Unit(benchmark::kMillisecond);
      }
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace
}  // namespace galactic::bench

int main(int argc, char** argv) {
  try {
    return galactic::bench::run(argc, argv);
  } catch (const std::exception& exception) {
    fmt::print(stderr, "column_query_benchmark: {}\n", exception.what());
    return 2;
  }
}
