#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "galactic/batch_renderer.h"
#include "galactic/sensor_noise.h"
#include "galactic/world_views.h"
#include "support/option_table.h"

namespace galactic {

/// What a run draws, and where the images go.
struct DrawingOptions {
  /// "rgb", "depth", "rgbd" or "rgbds" (with semantic ids); empty: nothing is drawn.
  std::string images;
  /// In pixels.
  std::uint32_t width = 128;
  std::uint32_t height = 128;
  RenderBackend backend = RenderBackend::kAuto;
  /// RenderOptions::device.
  std::string device;
  /// What the camera is mounted on, as in chooseCamera().
  std::string camera = "head";
  /// Vertical field of view; 0: that of the camera.
  float fov_degrees = 0;
  /// See CameraWish.
  std::array<float, 3> camera_position{};
  std::array<float, 3> camera_rpy_degrees{};
  float near = 0;
  /// Where the camera stands in the home and what it looks at: points in the world, meters. They
  /// replace the three options above that place it on the robot. Give both or neither.
  std::optional<std::array<float, 3>> eye;
  std::optional<std::array<float, 3>> look_at;
  ImageNoise noise;
  CameraJitter jitter;

  /// Whether a policy pack is played, which may need images: then backend, device, noise and jitter
  /// apply even if nothing else is drawn.
  bool policy_may_draw = false;

  /// A folder of PNG files, a contact sheet and a video; empty: none.
  std::string frames;
  std::string contact_sheet;
  std::string video;
  /// Pictures are made once in this many steps, and of this many envs, from the first one on.
  std::uint32_t frame_every = 1;
  std::uint32_t frame_envs = 4;

  /// Whether pictures show the simulation's internal state beside what the camera sees.
  bool debug_view = false;
  std::string debug_camera = "follow";
  /// Radius of the spheres whose column grid is shown, meters; 0: the smallest in the world.
  float debug_radius = 0;

  [[nodiscard]] bool draws() const { return !images.empty(); }
  [[nodiscard]] bool hasColor() const { return images.starts_with("rgb"); }
  [[nodiscard]] bool hasDepth() const { return images == "depth" || images.starts_with("rgbd"); }
  [[nodiscard]] bool hasSemantics() const { return images == "rgbds"; }
  [[nodiscard]] bool isNoisy() const {
    return noise.changesDepth() || noise.changesColor() || jitter.isOn();
  }
  [[nodiscard]] bool makesPictures() const {
    return !frames.empty() || !contact_sheet.empty() || !video.empty();
  }
};

/// What --help shows as the value of an option.
struct Shown {
  const char* value;
};

inline constexpr std::array<std::string_view, 4> kImageWords{"rgb", "depth", "rgbd", "rgbds"};
inline constexpr auto kBackendNames = [] {
  std::array<Named<RenderBackend>, kRenderBackends.size()> names{};
  for (std::size_t n = 0; n < names.size(); ++n) {
    names[n] = {kRenderBackends[n].name, kRenderBackends[n].backend};
  }
  return names;
}();
/// Heading of the drawing options.
inline constexpr const char* kDrawingGroup = "Rendering";

/// Visits each drawing option, in one place for the command line and for reports. Calls the
/// functions of the table of simulations (option_table.h) on `v`, and
///   word(name, field, words, help), size(name, drawing, help), text(name, field, Shown, help),
///   wish(name, field, Within, Shown, help), for a number that is 0 unless it is given,
///   three(name, field, most, Shown, help), point(name, field, most, Shown, help),
///   sensor(SensorOption, values).
template <class Visitor>
void visitDrawingOptions(DrawingOptions& d, Visitor& v) {
  constexpr Shown kCameras{"head|follow|top|LINK"};
  v.group(kDrawingGroup);
  v.word("render", d.images, kImageWords,
         "Draw each step: color, depth, both, or both and semantic ids");
  v.size("size", d, "Pixels of an image");
  v.choice("backend", d.backend, kBackendNames, "Renderer: CUDA, OpenGL, or the processor alone");
  v.text("device", d.device, Shown{"TEXT"},
         "For cuda and gl: an index, cuda:N, a UUID; for gl, software");
  v.text("camera", d.camera, kCameras,
         "The recipe's camera, one behind the robot, one above it, or a link");
  v.wish("fov", d.fov_degrees, Within<float>{kLeastFovDegrees, kMostFovDegrees}, Shown{"DEGREES"},
         "Vertical field of view, from the image's lower to its upper edge");
  v.three("camera-position", d.camera_position, kFarthestCamera, Shown{"X,Y,Z"},
          "The camera's place there: ahead, left, up, meters");
  v.three("camera-rpy", d.camera_rpy_degrees, 360, Shown{"R,P,Y"},
          "How it is turned there: roll, pitch, yaw, degrees");
  v.point("eye", d.eye, kFarthestPlace, Shown{"X,Y,Z"},
          "Stand there in the home instead of on the robot: a point in the world, meters");
  v.point("look-at", d.look_at, kFarthestPlace, Shown{"X,Y,Z"},
          "The point in the world that the camera at --eye looks at, meters");
  v.wish("near", d.near, Within<float>{kLeastNear, kMostNear}, Shown{"METERS"},
         "What is nearer than this is not drawn, meters");
  for (const auto& option : kImageNoiseOptions) v.sensor(option, d.noise);
  for (const auto& option : kCameraJitterOptions) v.sensor(option, d.jitter);
  v.text("frames", d.frames, Shown{"FOLDER"}, "Write PNG files of the first envs");
  v.text("contact-sheet", d.contact_sheet, Shown{"FILE.png"},
         "Write a sheet of envs (columns) at several moments (rows)");
  v.text("video", d.video, Shown{"FILE"}, "Write a video with ffmpeg");
  v.whole("frame-every", d.frame_every, Within<std::uint32_t>{1, 1U << 30U},
          "Steps from picture to picture");
  v.whole("frame-envs", d.frame_envs, Within<std::uint32_t>{1, 1024},
          "How many envs the pictures show");
  v.flag("debug-view", Switch{d.debug_view, true},
         "Show column grid, spheres and boxes beside the camera's image");
  v.text("debug-camera", d.debug_camera, kCameras,
         "Camera of the debug view, chosen as with --camera");
  v.real("debug-radius", d.debug_radius, Within<float>{0, 10},
         "Radius whose column grid is shown, meters; 0: the smallest");
}

}  // namespace galactic
