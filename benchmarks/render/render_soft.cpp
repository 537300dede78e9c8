// Images per second of the `soft` renderer, against a plain one: every triangle of every model
// transformed and drawn in turn, one pixel at a time, without culling or a depth hierarchy.
//
// The scene is a furnished apartment made here, unless GALACTIC_RENDER_PACKS names packs to draw
// instead (separated by ':'; all models of all packs, placed as they are). Each of `envs` cameras
// looks from its own place; objects and robot links stand elsewhere in every env. All times are of
// the processor, not of the clock: what other programs do changes little.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "galactic/batch_renderer.h"
#include "galactic/pack.h"
#include "render_apartment.h"
#include "render_plain.h"

namespace galactic {
namespace {

constexpr std::uint32_t kEdge = 128;

/// A library and the views of some envs into it.
struct Scene {
  std::vector<PackFile> packs;
  std::unique_ptr<test::RenderModelBuilder> apartment;
  RenderLibrary library;
  std::vector<std::vector<RenderInstance>> instances;
  std::vector<RenderView> views;
};

void addPacks(const char* list, Scene& scene) {
  std::string paths = list;
  for (std::size_t at = 0; at <= paths.size();) {
    const std::size_t end = std::min(paths.find(':', at), paths.size());
    Result<PackFile> pack = PackFile::open(paths.substr(at, end - at));
    if (!pack) {
      std::fprintf(stderr, "%s: %s\n", pack.error().where.c_str(), pack.error().message.c_str());
      std::exit(static_cast<int>(pack.error().code));
    }
    scene.packs.push_back(std::move(*pack));
    at = end + 1;
  }
  for (const PackFile& pack : scene.packs) {
    if (auto meshes = renderMeshesOf(pack); meshes && *meshes) scene.library.add(**meshes);
  }
}

Scene makeScene(std::size_t envs) {
  Scene scene;
  const char* packs = std::getenv("GALACTIC_RENDER_PACKS");
  if (packs != nullptr) {
    addPacks(packs, scene);
  } else {
    scene.apartment = std::make_unique<test::RenderModelBuilder>(apartmentMeshes());
    scene.library.add(scene.apartment->meshes());
  }
  std::mt19937 random(5);
  scene.instances.resize(envs);
  scene.views.resize(envs);
  for (std::size_t env = 0; env < envs; ++env) {
    scene.instances[env] =
        packs != nullptr ? everyModel(scene.library) : furnishedApartment(scene.library, random);
    scene.views[env].instances = scene.instances[env];
    scene.views[env].camera = cameraInApartment(random);
  }
  return scene;
}

/// Room for the images of a batch.
struct Images {
  explicit Images(std::size_t envs)
      : color(envs * kEdge * kEdge * 4), depth(envs * kEdge * kEdge) {}
  RenderTargets targets() { return {color, depth, {}}; }
  std::vector<std::uint8_t> color;
  std::vector<float> depth;
};

void report(benchmark::State& state, const Scene& scene, const RenderStatistics& statistics) {
  const auto envs = static_cast<double>(scene.views.size());
  const auto per_image = [&](std::uint64_t sum) { return static_cast<double>(sum) / envs; };
  state.counters["images/s"] =
      benchmark::Counter(envs, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["clusters"] = per_image(statistics.clusters);
  state.counters["drawn"] = per_image(statistics.clusters_drawn);
  state.counters["triangles"] = per_image(statistics.triangles_drawn);
  std::uint64_t triangles = 0;
  for (const RenderInstance& instance : scene.instances[0]) {
    triangles += scene.library.model(instance.model).triangles;
  }
  state.counters["all_triangles"] = static_cast<double>(triangles);
}

RenderOptions softOptions(std::uint32_t threads) {
  RenderOptions options;
  options.width = options.height = kEdge;
  options.backend = RenderBackend::kSoft;
  options.threads = threads;
  return options;
}

void drawSoft(benchmark::State& state, const RenderOptions& options) {
  const auto envs = static_cast<std::size_t>(state.range(0));
  const Scene scene = makeScene(envs);
  Result<BatchRenderer> renderer = BatchRenderer::create(scene.library, options);
  if (!renderer) return state.SkipWithError(renderer.error().message.c_str());
  Images images(envs);
  RenderTargets targets = images.targets();
  if (options.color == ColorFormat::kNone) targets.color = {};
  for (auto _ : state) renderer->render(scene.views, targets);
  report(state, scene, renderer->statistics());
}

void soft(benchmark::State& state) { drawSoft(state, softOptions(1)); }
void softTwoThreads(benchmark::State& state) { drawSoft(state, softOptions(2)); }

/// Depth alone: the difference to `soft` is the cost of records and shading.
void softDepth(benchmark::State& state) {
  RenderOptions options = softOptions(1);
  options.color = ColorFormat::kNone;
  drawSoft(state, options);
}

/// The differences to `soft` and `softDepth` are the cost of noise.
void softNoise(benchmark::State& state) {
  RenderOptions options = softOptions(1);
  options.noise = {
      .depth_noise = 0.01F, .depth_dropout = 0.02F, .color_noise = 5, .light_jitter = 0.2F};
  drawSoft(state, options);
}
void softDepthNoise(benchmark::State& state) {
  RenderOptions options = softOptions(1);
  options.color = ColorFormat::kNone;
  options.noise = {.depth_noise = 0.01F, .depth_dropout = 0.02F};
  drawSoft(state, options);
}

void softWithoutCulling(benchmark::State& state) {
  RenderOptions options = softOptions(1);
  options.culling = false;
  drawSoft(state, options);
}

void plain(benchmark::State& state) {
  const auto envs = static_cast<std::size_t>(state.range(0));
  const Scene scene = makeScene(envs);
  Images images(envs);
  constexpr std::size_t kPixels = std::size_t{kEdge} * kEdge;
  for (auto _ : state) {
    for (std::size_t env = 0; env < envs; ++env) {
      drawPlainly(scene.library, scene.views[env], kEdge,
                  std::span(images.color).subspan(env * kPixels * 4, kPixels * 4),
                  std::span(images.depth).subspan(env * kPixels, kPixels));
    }
  }
  report(state, scene, {});
}

BENCHMARK(plain)->Arg(32)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(soft)->Arg(32)->Arg(128)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(softDepth)->Arg(32)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(softNoise)->Arg(32)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(softDepthNoise)->Arg(32)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(softWithoutCulling)->Arg(32)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(softTwoThreads)->Arg(128)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace galactic

BENCHMARK_MAIN();
