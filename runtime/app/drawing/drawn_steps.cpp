#include "drawing/drawn_steps.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "support/try.h"

namespace galactic {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

DrawnSteps::DrawnSteps(Rendering rendering, PictureOutput output)
    : rendering_(std::move(rendering)), output_(std::move(output)) {}

Result<DrawnSteps> DrawnSteps::create(const World& world, const BatchSimulator& simulator,
                                      const RunOptions& options) {
  const PicturedRun run{
      .steps = options.steps,
      .envs = simulator.envCount(),
      .longest_name = std::ranges::max(world.episodes().objectNames(), {}, &std::string_view::size),
      .episodes = world.episodes().episodes().size()};
  const std::size_t shown = std::min<std::size_t>(options.drawing.frame_envs, run.envs);
  ASSIGN_OR_RETURN(
      Rendering rendering,
      Rendering::create(world, simulator, options, options.drawing.makesPictures() ? shown : 0));
  ASSIGN_OR_RETURN(PictureOutput output, PictureOutput::open(options.drawing, run));
  if (options.drawing.hasSemantics()) {
    const std::string legend = semanticLegend(rendering.semanticNames());
    RETURN_IF_ERROR(output.writeLegend(legend));
  }
  return DrawnSteps(std::move(rendering), std::move(output));
}

Result<void> DrawnSteps::step(BatchSimulator& simulator, std::span<const float> actions,
                              RunReport& report) {
  RenderReport& drawn = *report.rendering;
  const Clock::time_point start = Clock::now();
  rendering_.update(simulator);
  rendering_.begin();
  if (report.steps % kMeasureEvery == 1) {
    rendering_.end();
    drawn.rendering.add(secondsSince(start));
    const Clock::time_point rendered = Clock::now();
    simulator.step(actions);
    drawn.physics.add(secondsSince(rendered));
  } else {
    simulator.step(actions);
    rendering_.end();
    if (report.steps > 0) drawn.overlapped.add(secondsSince(start));
  }
  report.step_seconds += secondsSince(start);
  drawn.images += simulator.envCount();
  if (!output_.wants(report.steps)) return {};
  return output_.add(report.steps, rendering_.frames());
}

Result<void> DrawnSteps::finish(const BatchSimulator& simulator, const RunReport& report) {
  Result<void> added;
  if (output_.wantsLast(report.steps)) {
    rendering_.update(simulator);
    rendering_.begin();
    rendering_.end();
    added = output_.addLast(report.steps, rendering_.frames());
  }
  Result<void> finished = output_.finish();
  RETURN_IF_ERROR(added);
  return finished;
}

}  // namespace galactic
