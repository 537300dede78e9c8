// Nanoseconds per scan of the laser, and milliseconds for the plane that it is cast in: eight beams
// at a time against one, and against marching in steps of a third of a cell through the column
// grid. GALACTIC_BENCH_PACKS names a folder of scene packs; without it the scenes are made up.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <random>
#include <string>
#include <vector>

#include "column_query_scenes.h"
#include "sensors/scan_kernels.h"
#include "sensors/scan_plane.h"

namespace galactic::bench {
namespace {

using sensors::BeamBatch;
using sensors::ScanPlane;

constexpr std::uint32_t kSeed = 1;
constexpr float kHeight = 0.25F;
constexpr float kRange = 10;
constexpr std::size_t kMostBeams = 64;
/// Where robots stand: as many as a usual batch has.
constexpr std::size_t kPlaces = 1024;

struct Place {
  std::size_t scene = 0;
  Vec3 origin;
  float cosine = 1;
  float sine = 0;
};

class Scenes {
 public:
  explicit Scenes(SceneSource source) : source_(std::move(source)) {
    std::mt19937 random(kSeed);
    for (const auto& grids : source_.scenes())
      planes_.emplace_back(grids.front(), Span{kHeight, kHeight});
    while (places_.size() < kPlaces) tryPlace(random);
    for (std::size_t n = 0; n < kMostBeams; ++n) {
      constexpr double kTurn = 6.283185307179586;
      const double angle = kTurn * static_cast<double>(n) / kMostBeams;
      ahead_[n] = static_cast<float>(std::cos(angle));
      right_[n] = static_cast<float>(-std::sin(angle));
    }
  }

  [[nodiscard]] std::size_t count() const { return planes_.size(); }
  [[nodiscard]] const ColumnGrid& grid(std::size_t scene) const {
    return source_.scenes()[scene].front();
  }
  [[nodiscard]] const ScanPlane& plane(std::size_t scene) const { return planes_[scene]; }
  [[nodiscard]] const std::vector<Place>& places() const { return places_; }

  /// A whole turn of `count` beams, a part of kMostBeams.
  [[nodiscard]] BeamBatch beams(const Place& place, std::size_t count) const {
    return {place.origin, place.cosine, place.sine, ahead_.data(), right_.data(), count, kRange};
  }

 private:
  /// Where a base of 30 cm is free.
  void tryPlace(std::mt19937& random) {
    std::uniform_real_distribution<float> share(0, 1);
    Place place;
    place.scene = random() % planes_.size();
    const ColumnGridLayout& layout = grid(place.scene).layout();
    place.origin = {
        layout.min_x + share(random) * static_cast<float>(layout.columns_x) * layout.spacing,
        kHeight,
        layout.min_z + share(random) * static_cast<float>(layout.columns_z) * layout.spacing};
    const float yaw = 6.2831853F * share(random);
    place.cosine = std::cos(yaw);
    place.sine = std::sin(yaw);
    for (int n = 0; n < 16; ++n) {
      const float angle = 0.3926991F * static_cast<float>(n);
      for (const float reach : {0.0F, 0.15F, 0.3F}) {
        const Vec3 at{place.origin.x + reach * std::cos(angle), kHeight,
                      place.origin.z + reach * std::sin(angle)};
        if (grid(place.scene).clearance(at) != Clearance::kFree) return;
      }
    }
    places_.push_back(place);
  }

  SceneSource source_;
  std::vector<ScanPlane> planes_;
  std::vector<Place> places_;
  std::array<float, kMostBeams> ahead_{};
  std::array<float, kMostBeams> right_{};
};

void cast(benchmark::State& state, const Scenes& scenes, sensors::ScanKernels kernels) {
  const auto count = static_cast<std::size_t>(state.range(0));
  std::array<float, kMostBeams> distances{};
  std::size_t n = 0;
  for ([[maybe_unused]] auto _ : state) {
    const Place& place = scenes.places()[n++ % kPlaces];
    kernels.cast_scene(scenes.plane(place.scene).view(), scenes.beams(place, count),
                       distances.data());
    benchmark::DoNotOptimize(distances);
  }
}

void march(benchmark::State& state, const Scenes& scenes) {
  const auto count = static_cast<std::size_t>(state.range(0));
  std::array<float, kMostBeams> distances{};
  std::size_t n = 0;
  for ([[maybe_unused]] auto _ : state) {
    const Place& place = scenes.places()[n++ % kPlaces];
    const ColumnGrid& grid = scenes.grid(place.scene);
    const BeamBatch beams = scenes.beams(place, count);
    for (std::size_t b = 0; b < count; ++b) {
      const float x = beams.cosine * beams.ahead[b] + beams.sine * beams.right[b];
      const float z = beams.cosine * beams.right[b] - beams.sine * beams.ahead[b];
      float way = 0;
      Vec3 at = place.origin;
      while (way < kRange && grid.clearance(at) == Clearance::kFree) {
        way += grid.spacing() / 3;
        at.x = place.origin.x + way * x;
        at.z = place.origin.z + way * z;
      }
      distances[b] = way;
    }
    benchmark::DoNotOptimize(distances);
  }
}

void cut(benchmark::State& state, const Scenes& scenes) {
  std::size_t n = 0;
  std::size_t bytes = 0;
  for ([[maybe_unused]] auto _ : state) {
    const ScanPlane plane(scenes.grid(n++ % scenes.count()), {kHeight, kHeight});
    bytes = plane.bytes();
    benchmark::DoNotOptimize(bytes);
  }
  state.counters["bytes"] = static_cast<double>(bytes);
}

SceneSource sceneSource() {
  const char* folder = std::getenv("GALACTIC_BENCH_PACKS");
  return folder == nullptr ? SceneSource::synthetic() : SceneSource::fromPacks(folder);
}

int run(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const Scenes scenes(sceneSource());
  const auto add = [](const char* name, auto body) {
    for (const int beams : {8, 16, 32, 64}) benchmark::RegisterBenchmark(name, body)->Arg(beams);
  };
  if (__builtin_cpu_supports("avx2") != 0) {
    add("eight beams at a time",
        [&](benchmark::State& s) { cast(s, scenes, sensors::avx2Scan()); });
  }
  add("one beam at a time", [&](benchmark::State& s) { cast(s, scenes, sensors::portableScan()); });
  add("marching", [&](benchmark::State& s) { march(s, scenes); });
  benchmark::RegisterBenchmark("cut a plane", [&](benchmark::State& s) {
    cut(s, scenes);
  })->Unit(benchmark::kMillisecond);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace galactic::bench

int main(int argc, char** argv) {
  try {
    return galactic::bench::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "laser_scan: {}\n", error.what());
    return 1;
  }
}
