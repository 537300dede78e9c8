// Draws what the robots of a world see, into memory. Usage: draw_views WORLD
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "galactic/batch_renderer.h"
#include "galactic/batch_simulator.h"
#include "galactic/world_models.h"
#include "galactic/world_views.h"

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: draw_views WORLD\n");
    return galactic::kExitUsage;
  }
  const auto world = orThrow(galactic::World::open(argv[1]));
  galactic::SimulationOptions options = world.withTask();
  options.envs = 16;
  options.body_transforms = true;  // cameras and links move with bodies
  auto simulator = orThrow(galactic::BatchSimulator::create(world, options));

  const auto models = orThrow(galactic::WorldModels::from(world));
  const auto camera = orThrow(galactic::chooseCamera(world.robot(), {.name = "follow"}));
  const galactic::RenderOptions drawing{.width = 64, .height = 48, .near = camera.near};
  auto renderer = orThrow(galactic::BatchRenderer::create(models.library(), drawing));
  galactic::WorldViews views(models, simulator, camera.mount);

  const std::size_t pixels = simulator.envCount() * drawing.height * drawing.width;
  std::vector<std::uint8_t> color(pixels * 4);
  std::vector<float> depth(pixels);
  const std::vector<float> actions(simulator.envCount() * simulator.actionCount());
  for (int step = 0; step < 10; ++step) {
    views.update(simulator);
    // Draws this state while the next one is simulated.
    renderer.beginRender(views.views(), {.color = color, .depth = depth});
    simulator.step(actions);
    renderer.endRender();
  }
  std::printf("%s: farthest %.1f m\n", renderer.description().c_str(),
              static_cast<double>(*std::ranges::max_element(depth)));
  return galactic::kExitOk;
} catch (const galactic::ErrorException& failure) {
  std::fprintf(stderr, "%s\n", failure.what());
  return static_cast<int>(failure.error().code);
}
