// Images of 128 x 128 pixels, color and depth, by the OpenGL backend, by the rasterizer, and by
// OpenGL one env after the other with nothing culled; images of several sizes by the CUDA backend:
//
//   render_gl                                        on a home made in code
//   GALACTIC_RENDER_WORLD=world.pack render_gl       on a world that was baked
//   GALACTIC_RENDER_DEVICE=cuda:0 render_gl          on a graphics processor; "software" without
//   one
//
// items_per_second counts images per second of the processor's time; images_per_second by the
// clock. On a graphics processor the share of its time that went into drawing and reading back
// comes from timer queries, that of the processor from the clock.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/world.h"
#include "galactic/world_models.h"
#include "galactic/world_views.h"
#include "render/cuda/cuda_engine.h"
#include "render/gl/gl_engine.h"
#include "render_apartment.h"
#include "support/render_images.h"

namespace {

using galactic::BatchSimulator;
using galactic::RenderBackend;
using galactic::RenderLibrary;
using galactic::RenderOptions;
using galactic::RenderView;
using galactic::Result;
using galactic::World;
using galactic::WorldModels;
using galactic::WorldViews;
using galactic::render::RenderEngine;
using galactic::render::cuda::CudaEngine;
using galactic::render::gl::GlEngine;
using galactic::render::gl::GlTimings;

template <class T>
T orExit(Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "%s: %s\n", result.error().where.c_str(), result.error().message.c_str());
  std::exit(static_cast<int>(result.error().code));
}

/// The apartment that the benchmark of the soft renderer draws, too.
class MadeHome {
 public:
  MadeHome() { library_.add(meshes_.meshes()); }

  [[nodiscard]] const RenderLibrary& library() const { return library_; }

  /// Valid until the next call.
  std::vector<RenderView> views(std::size_t count) {
    std::mt19937 random(5);
    instances_.assign(count, {});
    std::vector<RenderView> views(count);
    for (std::size_t env = 0; env < count; ++env) {
      instances_[env] = galactic::furnishedApartment(library_, random);
      views[env] = {galactic::cameraInApartment(random), instances_[env]};
    }
    return views;
  }

 private:
  galactic::test::RenderModelBuilder meshes_ = galactic::apartmentMeshes();
  RenderLibrary library_;
  std::vector<std::vector<galactic::RenderInstance>> instances_;
};

/// What is drawn: a world that was baked, at the beginning of its episodes, or the made home.
class Scene {
 public:
  Scene() {
    const char* path = std::getenv("GALACTIC_RENDER_WORLD");
    if (path == nullptr || *path == '\0') return;
    world_ = std::make_unique<World>(orExit(World::open(std::vector<std::filesystem::path>{path})));
    models_ = std::make_unique<WorldModels>(orExit(WorldModels::from(*world_)));
  }

  [[nodiscard]] const RenderLibrary& library() const {
    return models_ ? models_->library() : home_.library();
  }

  std::vector<RenderView> views(std::size_t count) {
    if (!models_) return home_.views(count);
    galactic::SimulationOptions options;
    options.envs = static_cast<std::uint32_t>(count);
    options.body_transforms = true;
    simulator_ = std::make_unique<BatchSimulator>(orExit(BatchSimulator::create(*world_, options)));
    const auto camera = galactic::robotCamera(world_->robot());
    world_views_ = std::make_unique<WorldViews>(*models_, *simulator_,
                                                camera.value_or(galactic::CameraMount{}));
    world_views_->update(*simulator_);
    return {world_views_->views().begin(), world_views_->views().end()};
  }

 private:
  MadeHome home_;
  std::unique_ptr<World> world_;
  std::unique_ptr<WorldModels> models_;
  std::unique_ptr<BatchSimulator> simulator_;
  std::unique_ptr<WorldViews> world_views_;
};

RenderOptions optionsFor(RenderBackend backend) {
  RenderOptions options;
  options.backend = backend;
  options.threads = 1;
  const char* device = std::getenv("GALACTIC_RENDER_DEVICE");
  options.device = device == nullptr ? "software" : device;
  return options;
}

/// Draws until the benchmark has enough, and says how fast.
void drawBatches(benchmark::State& state, RenderEngine& engine, std::span<const RenderView> views,
                 const RenderOptions& options) {
  galactic::test::RenderImages images = galactic::test::emptyImages(options, views.size());
  const auto draw = [&] {
    engine.begin(views, galactic::test::targetsOf(images));
    engine.end();
  };
  // The first batch makes room.
  draw();
  const auto start = std::chrono::steady_clock::now();
  for ([[maybe_unused]] const auto iteration : state) draw();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  const auto count = static_cast<double>(state.iterations()) * static_cast<double>(views.size());
  state.SetItemsProcessed(static_cast<std::int64_t>(count));
  state.counters["images_per_second"] = count / wall.count();
  const galactic::RenderStatistics statistics = engine.statistics();
  const auto per_image = [&](std::uint64_t sum) {
    return static_cast<double>(sum) / static_cast<double>(views.size());
  };
  state.counters["clusters"] = per_image(statistics.clusters_drawn);
  state.counters["of_clusters"] = per_image(statistics.clusters);
  state.counters["triangles"] = per_image(statistics.triangles_drawn);
  state.SetLabel(engine.description());
}

void drawWithGl(benchmark::State& state, Scene& scene, const RenderOptions& options) {
  const bool plain = !options.culling;
  const auto views = scene.views(static_cast<std::size_t>(state.range(0)));
  auto engine =
      GlEngine::make(scene.library(), options, {.most_views = plain ? 1U : 0U, .measure = true},
                     galactic::render::gl::loadsLibrary);
  if (!engine) return state.SkipWithError(engine.error().message.c_str());
  const auto start = std::chrono::steady_clock::now();
  drawBatches(state, **engine, views, options);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  const GlTimings& timings = (*engine)->timings();
  state.counters["share_setup"] = timings.setup / wall.count();
  state.counters["share_draw"] = timings.draw / wall.count();
  state.counters["share_readback"] = timings.readback / wall.count();
  state.counters["share_copy"] = timings.copy / wall.count();
}

/// The second argument of benchmarks that have one: pixels along the image's edge.
RenderOptions optionsOf(RenderBackend backend, const benchmark::State& state) {
  RenderOptions options = optionsFor(backend);
  options.width = options.height = static_cast<std::uint32_t>(state.range(1));
  if (options.device == "software" && backend == RenderBackend::kCuda) options.device = "";
  return options;
}

/// Draws batches that stay on the device.
void leaveOnDevice(benchmark::State& state, RenderEngine& engine,
                   std::span<const RenderView> views) {
  if (const auto first = engine.renderToDevice(views, 0); !first) {
    return state.SkipWithError(first.error().message.c_str());
  }
  const auto start = std::chrono::steady_clock::now();
  for ([[maybe_unused]] const auto iteration : state) {
    benchmark::DoNotOptimize(engine.renderToDevice(views, 0));
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  const auto count = static_cast<double>(state.iterations()) * static_cast<double>(views.size());
  state.SetItemsProcessed(static_cast<std::int64_t>(count));
  state.counters["images_per_second"] = count / wall.count();
  state.SetLabel(engine.description());
}

void drawWithCuda(benchmark::State& state, Scene& scene, bool on_device, bool measure) {
  const RenderOptions options = optionsOf(RenderBackend::kCuda, state);
  const auto views = scene.views(static_cast<std::size_t>(state.range(0)));
  auto engine = CudaEngine::make(scene.library(), options, {.measure = measure});
  if (!engine) return state.SkipWithError(engine.error().message.c_str());
  const auto start = std::chrono::steady_clock::now();
  if (on_device) {
    leaveOnDevice(state, **engine, views);
  } else {
    drawBatches(state, **engine, views, options);
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  const galactic::render::cuda::CudaTimings& timings = (*engine)->timings();
  state.counters["share_setup"] = timings.setup / wall.count();
  if (!on_device) state.counters["share_readback"] = timings.readback / wall.count();
  if (!measure) return;
  for (std::size_t n = 0; n < timings.kernels.size(); ++n) {
    const std::string name = galactic::render::cuda::kKernelNames[n];
    state.counters["share" + name.substr(name.find('_'))] = timings.kernels[n] / wall.count();
  }
}

/// What the processor does for a batch before the device draws it; with GALACTIC_STANDIN_IDLE set,
/// the tests' stand-in draws nothing.
void setUpCuda(benchmark::State& state, Scene& scene) {
  RenderOptions options = optionsOf(RenderBackend::kCuda, state);
  const auto views = scene.views(static_cast<std::size_t>(state.range(0)));
  auto engine = CudaEngine::make(scene.library(), options, {});
  if (!engine) return state.SkipWithError(engine.error().message.c_str());
  leaveOnDevice(state, **engine, views);
  // The first batch made room.
  const auto batches = static_cast<double>(state.iterations() + 1);
  state.counters["setup_ms"] = 1e3 * (*engine)->timings().setup / batches;
}

/// Draws the same batch with the cuda backend and on the processor: an error where a byte differs.
void compareWithSoft(benchmark::State& state, Scene& scene) {
  RenderOptions options = optionsOf(RenderBackend::kCuda, state);
  options.semantics = true;
  const auto views = scene.views(static_cast<std::size_t>(state.range(0)));
  const auto draw = [&](RenderEngine& engine) {
    galactic::test::RenderImages images = galactic::test::emptyImages(options, views.size());
    engine.begin(views, galactic::test::targetsOf(images));
    engine.end();
    return images;
  };
  auto cuda = CudaEngine::make(scene.library(), options, {});
  if (!cuda) return state.SkipWithError(cuda.error().message.c_str());
  options.backend = RenderBackend::kSoft;
  auto soft = galactic::render::makeSoftEngine(scene.library(), options);
  if (!soft) return state.SkipWithError(soft.error().message.c_str());
  for ([[maybe_unused]] const auto iteration : state) {
    if (draw(**cuda) != draw(**soft)) return state.SkipWithError("the images differ");
  }
  state.SetItemsProcessed(state.range(0));
  state.SetLabel((*cuda)->description());
}

/// OpenGL's images in CUDA's memory: in the context that this thread has then.
void leaveWithGl(benchmark::State& state, Scene& scene) {
  const RenderOptions options = optionsOf(RenderBackend::kGl, state);
  const auto driver = galactic::render::cuda::Driver::open();
  if (!driver) return state.SkipWithError(driver.error().message.c_str());
  const std::string device_name = options.device == "software" ? "" : options.device;
  auto device = galactic::render::cuda::Device::choose(**driver, device_name);
  if (!device) return state.SkipWithError(device.error().message.c_str());
  if (const auto opened = device->open(); !opened) {
    return state.SkipWithError(opened.error().message.c_str());
  }
  const galactic::render::cuda::CurrentDevice current(**driver, *device);
  const auto views = scene.views(static_cast<std::size_t>(state.range(0)));
  auto engine = galactic::render::makeGlEngine(scene.library(), options);
  if (!engine) return state.SkipWithError(engine.error().message.c_str());
  leaveOnDevice(state, **engine, views);
}

void drawWithSoft(benchmark::State& state, Scene& scene) {
  const RenderOptions options = optionsFor(RenderBackend::kSoft);
  const auto views = scene.views(static_cast<std::size_t>(state.range(0)));
  auto engine = galactic::render::makeSoftEngine(scene.library(), options);
  if (!engine) return state.SkipWithError(engine.error().message.c_str());
  drawBatches(state, **engine, views, options);
}

int run(int argc, char** argv) {
  Scene scene;
  const auto add = [&](const char* name, auto run) {
    benchmark::RegisterBenchmark(name, run)
        ->Arg(32)
        ->Arg(128)
        ->Arg(512)
        ->Arg(2048)
        ->MeasureProcessCPUTime()
        ->Unit(benchmark::kMillisecond);
  };
  add("gl",
      [&](benchmark::State& state) { drawWithGl(state, scene, optionsFor(RenderBackend::kGl)); });
  add("gl_one_by_one", [&](benchmark::State& state) {
    RenderOptions options = optionsFor(RenderBackend::kGl);
    options.culling = false;
    drawWithGl(state, scene, options);
  });
  add("soft", [&](benchmark::State& state) { drawWithSoft(state, scene); });
  // On a graphics processor, by views and pixels along an edge.
  const auto add_sizes = [&](const char* name, auto run) {
    benchmark::RegisterBenchmark(name, run)
        ->ArgsProduct({{8, 128, 512, 2048, 8192}, {64, 128}})
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  };
  add_sizes("cuda_read",
            [&](benchmark::State& state) { drawWithCuda(state, scene, false, false); });
  add_sizes("cuda_stay", [&](benchmark::State& state) { drawWithCuda(state, scene, true, false); });
  add_sizes("cuda_shares",
            [&](benchmark::State& state) { drawWithCuda(state, scene, true, true); });
  benchmark::RegisterBenchmark("cuda_setup",
                               [&](benchmark::State& state) { setUpCuda(state, scene); })
      ->Args({4096, 32})
      ->Unit(benchmark::kMillisecond);
  add_sizes("gl_read", [&](benchmark::State& state) {
    drawWithGl(state, scene, optionsOf(RenderBackend::kGl, state));
  });
  add_sizes("gl_stay", [&](benchmark::State& state) { leaveWithGl(state, scene); });
  benchmark::RegisterBenchmark("same_as_soft",
                               [&](benchmark::State& state) { compareWithSoft(state, scene); })
      ->ArgsProduct({{8, 128}, {64, 128, 300}})
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(galactic::ErrorCode::kInternal);
  }
}
