#include "command_line/render_command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "galactic/sensor_noise.h"

namespace galactic {
namespace {

/// Whether a drawing option also applies to what a policy sees.
bool isForPolicies(std::string_view name) {
  const auto is_it = [name](const auto& option) { return name.substr(2) == option.name; };
  return name == "--backend" || name == "--device" ||
         std::ranges::any_of(kImageNoiseOptions, is_it) ||
         std::ranges::any_of(kCameraJitterOptions, is_it);
}

/// The complaint about noise for images that are not drawn.
std::string noiseFault(const DrawingOptions& drawing) {
  constexpr const char* kFault = "{} applies to {} only; draw it with --render {}, or leave {} out";
  if (drawing.noise.changesDepth() && !drawing.hasDepth()) {
    const char* name = drawing.noise.depth_noise.most > 0 ? "--depth-noise" : "--depth-dropout";
    return fmt::format(kFault, name, "depth", "rgbd", name);
  }
  if (drawing.noise.changesColor() && !drawing.hasColor()) {
    const char* name = drawing.noise.color_noise.most > 0 ? "--color-noise" : "--light-jitter";
    return fmt::format(kFault, name, "color", "rgbd", name);
  }
  return {};
}

/// The complaint about a camera that stands in the home.
std::string eyeFault(const DrawingOptions& drawing, const CLI::App& app) {
  if (drawing.eye.has_value() != drawing.look_at.has_value()) {
    return drawing.eye ? "--eye needs --look-at, what the camera looks at; add it"
                       : "--look-at needs --eye, where the camera stands; add it";
  }
  if (!drawing.eye) return {};
  if (drawing.eye == drawing.look_at) {
    return fmt::format("--look-at is where --eye is, at {}; give another point",
                       fmt::join(*drawing.eye, ","));
  }
  for (const char* name : {"--camera", "--camera-position", "--camera-rpy"}) {
    if (app.count(name) == 0) continue;
    return fmt::format("{} places the camera on the robot, and --eye in the home; leave one out",
                       name);
  }
  return {};
}

}  // namespace

std::string drawingFault(const DrawingOptions& drawing, const CLI::App& app) {
  if (!drawing.draws()) {
    for (const CLI::Option* option : app.get_options()) {
      if (option->count() == 0 || option->get_group() != kDrawingGroup) continue;
      const std::string name = option->get_name();
      if (drawing.policy_may_draw && isForPolicies(name)) continue;
      return fmt::format("{} applies to rendering only; add --render", name);
    }
  }
  if (drawing.draws() && !drawing.policy_may_draw) {
    if (std::string fault = noiseFault(drawing); !fault.empty()) return fault;
  }
  if (drawing.backend == RenderBackend::kSoft && !drawing.device.empty()) {
    return "--device applies to --backend cuda and gl only; leave it out";
  }
  if (std::string fault = eyeFault(drawing, app); !fault.empty()) return fault;
  const bool shapes_pictures = app.count("--frame-every") + app.count("--frame-envs") > 0;
  if (!drawing.makesPictures() && (drawing.debug_view || shapes_pictures)) {
    return fmt::format("{} applies to pictures only; add --frames, --contact-sheet or --video",
                       drawing.debug_view ? "--debug-view" : "--frame-every or --frame-envs");
  }
  if (!drawing.debug_view && app.count("--debug-camera") + app.count("--debug-radius") > 0) {
    return "--debug-camera and --debug-radius apply to the debug view only; add --debug-view";
  }
  return {};
}

}  // namespace galactic
