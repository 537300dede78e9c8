#include "command_line/render_command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <map>
#include <optional>
#include <string_view>

#include "galactic/batch_renderer.h"
#include "galactic/world_views.h"
#include "support/number_text.h"

namespace galactic {
namespace {

constexpr const char* kGroup = "Rendering";

/// A whole number of 1 to kLargestImage.
std::optional<std::uint32_t> edgeOf(std::string_view text) {
  std::uint32_t edge = 0;
  const char* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, edge);
  if (problem != std::errc() || stop != end || edge < 1 || edge > kLargestImage) return {};
  return edge;
}

/// "128" or "160x120".
std::optional<std::pair<std::uint32_t, std::uint32_t>> sizeOf(std::string_view text) {
  const std::size_t cross = text.find('x');
  const auto width = edgeOf(text.substr(0, cross));
  const auto height = cross == std::string_view::npos ? width : edgeOf(text.substr(cross + 1));
  if (!width || !height) return {};
  return std::pair(*width, *height);
}

void addSize(CLI::App& app, DrawingOptions& drawing) {
  const CLI::Validator is_size(
      [](const std::string& text) {
        if (sizeOf(text)) return std::string();
        return fmt::format("found {}, expected N or WIDTHxHEIGHT, each 1 to {}", text,
                           kLargestImage);
      },
      "", "size");
  const auto set = [&drawing](const std::string& text) {
    if (const auto size = sizeOf(text)) std::tie(drawing.width, drawing.height) = *size;
  };
  app.add_option_function<std::string>("--size", set, "Pixels of an image")
      ->check(is_size)
      ->option_text("N|WxH [128]");
}

/// "0.1,0,-2": three numbers of -most to most.
std::optional<std::array<float, 3>> threeOf(std::string_view text, double most) {
  std::array<float, 3> numbers{};
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    const std::size_t end = n + 1 < numbers.size() ? text.find(',') : text.size();
    if (end == std::string_view::npos) return {};
    const std::string_view one = text.substr(0, end);
    if (!numberFault(one, -most, most).empty()) return {};
    std::from_chars(one.data(), one.data() + one.size(), numbers[n]);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return numbers;
}

struct NameAndText {
  const char* name;
  const char* text;
};

CLI::Option* addThree(CLI::App& app, const NameAndText& option, double most,
                      std::array<float, 3>& numbers) {
  const CLI::Validator are_three(
      [most](const std::string& text) {
        if (threeOf(text, most)) return std::string();
        return fmt::format("found {}, expected three numbers from {} to {} with commas between",
                           text, -most, most);
      },
      "", "three");
  const auto set = [&numbers, most](const std::string& text) {
    if (const auto three = threeOf(text, most)) numbers = *three;
  };
  return app.add_option_function<std::string>(option.name, set, option.text)->check(are_three);
}

void addBackend(CLI::App& app, DrawingOptions& drawing) {
  const std::map<std::string, RenderBackend> backends{{"auto", RenderBackend::kAuto},
                                                      {"cuda", RenderBackend::kCuda},
                                                      {"gl", RenderBackend::kGl},
                                                      {"soft", RenderBackend::kSoft}};
  const auto set = [&drawing, backends](const std::string& text) {
    drawing.backend = backends.at(text);
  };
  app.add_option_function<std::string>("--backend", set,
                                       "Renderer: CUDA, OpenGL, or the processor alone")
      ->check(CLI::IsMember({"auto", "cuda", "gl", "soft"}))
      ->option_text("auto|cuda|gl|soft [auto]");
  app.add_option("--device", drawing.device,
                 "For cuda and gl: an index, cuda:N, a UUID; for gl, software")
      ->type_name("TEXT");
}

template <class Options>
void addSensor(CLI::App& app, const SensorOption<Options>& option, Options& options) {
  app.add_option("--" + std::string(option.name), options.*option.value, option.text)
      ->check(numberCheck(0, static_cast<double>(option.most)))
      ->option_text(fmt::format("{} [0]", option.unit));
}

/// Whether an option of drawing counts for what a policy sees, too.
bool isForPolicies(std::string_view name) {
  const auto is_it = [name](const auto& option) { return name.substr(2) == option.name; };
  return name == "--backend" || name == "--device" ||
         std::ranges::any_of(kImageNoiseOptions, is_it) ||
         std::ranges::any_of(kCameraJitterOptions, is_it);
}

/// Of noise of images that are not drawn.
std::string noiseFault(const DrawingOptions& drawing) {
  constexpr const char* kFault = "{} applies to {} only; draw it with --render {}, or leave {} out";
  if (drawing.noise.changesDepth() && !drawing.hasDepth()) {
    const char* name = drawing.noise.depth_noise > 0 ? "--depth-noise" : "--depth-dropout";
    return fmt::format(kFault, name, "depth", "rgbd", name);
  }
  if (drawing.noise.changesColor() && !drawing.hasColor()) {
    const char* name = drawing.noise.color_noise > 0 ? "--color-noise" : "--light-jitter";
    return fmt::format(kFault, name, "color", "rgbd", name);
  }
  return {};
}

void addPictures(CLI::App& app, DrawingOptions& drawing) {
  app.add_option("--frames", drawing.frames, "Write PNG files of the first envs")
      ->type_name("FOLDER");
  app.add_option("--contact-sheet", drawing.contact_sheet,
                 "Write a sheet of envs (columns) at several moments (rows)")
      ->type_name("FILE.png");
  app.add_option("--video", drawing.video, "Write a video with ffmpeg")->type_name("FILE");
  app.add_option("--frame-every", drawing.frame_every, "Steps from picture to picture")
      ->check(wholeCheck(1, 1U << 30U))
      ->option_text(fmt::format("N [{}]", drawing.frame_every));
  app.add_option("--frame-envs", drawing.frame_envs, "How many envs the pictures show")
      ->check(wholeCheck(1, 1024))
      ->option_text(fmt::format("N [{}]", drawing.frame_envs));
}

void addDebug(CLI::App& app, DrawingOptions& drawing) {
  app.add_flag("--debug-view", drawing.debug_view,
               "Show column grid, spheres and boxes beside the camera's image")
      ->check(switchCheck());
  app.add_option("--debug-camera", drawing.debug_camera,
                 "Camera of the debug view, chosen as with --camera")
      ->option_text(fmt::format("head|follow|top|LINK [{}]", drawing.debug_camera));
  app.add_option("--debug-radius", drawing.debug_radius,
                 "Radius whose column grid is shown, meters; 0: the smallest")
      ->check(numberCheck(0, 10))
      ->option_text("METERS [0]");
}

}  // namespace

void addDrawingOptions(CLI::App& app, DrawingOptions& drawing) {
  app.option_defaults()->group(kGroup);
  app.add_option("--render", drawing.images,
                 "Draw each step: color, depth, both, or both and semantic ids")
      ->check(CLI::IsMember({"rgb", "depth", "rgbd", "rgbds"}))
      ->option_text("rgb|depth|rgbd|rgbds");
  addSize(app, drawing);
  addBackend(app, drawing);
  app.add_option("--camera", drawing.camera,
                 "The recipe's camera, one behind the robot, one above it, or a link")
      ->option_text(fmt::format("head|follow|top|LINK [{}]", drawing.camera));
  app.add_option("--fov", drawing.fov_degrees,
                 "Vertical field of view, from the image's lower to its upper edge")
      ->check(
          numberCheck(static_cast<double>(kLeastFovDegrees), static_cast<double>(kMostFovDegrees)))
      ->option_text("DEGREES");
  addThree(app, {"--camera-position", "The camera's place there: ahead, left, up, meters"},
           static_cast<double>(kFarthestCamera), drawing.camera_position)
      ->option_text("X,Y,Z [0,0,0]");
  addThree(app, {"--camera-rpy", "How it is turned there: roll, pitch, yaw, degrees"}, 360,
           drawing.camera_rpy_degrees)
      ->option_text("R,P,Y [0,0,0]");
  app.add_option("--near", drawing.near, "What is nearer than this is not drawn, meters")
      ->check(numberCheck(static_cast<double>(kLeastNear), static_cast<double>(kMostNear)))
      ->option_text("METERS");
  for (const auto& option : kImageNoiseOptions) addSensor(app, option, drawing.noise);
  for (const auto& option : kCameraJitterOptions) addSensor(app, option, drawing.jitter);
  addPictures(app, drawing);
  addDebug(app, drawing);
  app.option_defaults()->group("Options");
}

std::string drawingFault(const DrawingOptions& drawing, const CLI::App& app) {
  if (!drawing.draws()) {
    for (const CLI::Option* option : app.get_options()) {
      if (option->count() == 0 || option->get_group() != kGroup) continue;
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
