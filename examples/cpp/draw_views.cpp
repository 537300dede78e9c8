// Draws what the robots of a world see, into memory. Usage: draw_views WORLD
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "galactic/batch_renderer.h"
#include "galactic/batch_simulator.h"
#include "galactic/world_models.h"
#include "galactic/world_views.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: draw_views WORLD\n");
    return galactic::kExitUsage;
  }
  const auto refuse = [](const galactic::Error& error) {
    std::fprintf(stderr, "%s: %s\n", error.where.c_str(), error.message.c_str());
    return static_cast<int>(error.code);
  };
  const std::vector<std::filesystem::path> packs{argv[1]};
  const auto world = galactic::World::open(packs);
  if (!world) return refuse(world.error());
  galactic::SimulationOptions options = world->withTask();
  options.envs = 16;
  options.body_transforms = true;  // cameras and links move with bodies
  auto simulator = galactic::BatchSimulator::create(*world, options);
  if (!simulator) return refuse(simulator.error());

  const auto models = galactic::WorldModels::from(*world);
  if (!models) return refuse(models.error());
  const auto camera = galactic::chooseCamera(world->robot(), {.name = "follow"});
  if (!camera) return refuse(camera.error());
  const galactic::RenderOptions drawing{.width = 64, .height = 48, .near = camera->near};
  auto renderer = galactic::BatchRenderer::create(models->library(), drawing);
  if (!renderer) return refuse(renderer.error());
  galactic::WorldViews views(*world, *models, *simulator, camera->mount);

  const std::size_t pixels = simulator->envCount() * drawing.height * drawing.width;
  std::vector<std::uint8_t> color(pixels * 4);
  std::vector<float> depth(pixels);
  const std::vector<float> actions(simulator->envCount() * simulator->actionCount());
  for (int step = 0; step < 10; ++step) {
    views.update(*simulator);
    // Draws this state while the next one is simulated.
    renderer->beginRender(views.views(), {.color = color, .depth = depth});
    simulator->step(actions);
    renderer->endRender();
  }
  std::printf("%s: farthest %.1f m\n", renderer->description().c_str(),
              static_cast<double>(*std::ranges::max_element(depth)));
  return galactic::kExitOk;
}
