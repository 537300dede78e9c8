#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "galactic/batch_renderer.h"
#include "galactic/sensor_noise.h"

namespace galactic {

/// What is drawn during a run, and what becomes of it.
struct DrawingOptions {
  /// "rgb", "depth", "rgbd" or "rgbds" (with semantic ids); empty: nothing is drawn.
  std::string images;
  /// Pixels.
  std::uint32_t width = 128;
  std::uint32_t height = 128;
  RenderBackend backend = RenderBackend::kAuto;
  /// RenderOptions::device.
  std::string device;
  /// What the camera moves with: chooseCamera().
  std::string camera = "head";
  /// Between the lower and the upper edge; 0: what belongs to the camera.
  float fov_degrees = 0;
  /// CameraWish has the rest.
  std::array<float, 3> camera_position{};
  std::array<float, 3> camera_rpy_degrees{};
  float near = 0;
  ImageNoise noise;
  CameraJitter jitter;

  /// Whether a policy pack is played, which may want images: then backend, device, noise and jitter
  /// count, whether or not anything else is drawn.
  bool policy_may_draw = false;

  /// Folder of PNG files, contact sheet and video; empty for none.
  std::string frames;
  std::string contact_sheet;
  std::string video;
  /// Each how many steps, and of the first how many envs, there is a picture.
  std::uint32_t frame_every = 1;
  std::uint32_t frame_envs = 4;

  /// Whether pictures show what the simulation knows beside what the camera sees.
  bool debug_view = false;
  std::string debug_camera = "follow";
  /// Whose column grid is shown, meters; 0: the smallest of the world.
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

}  // namespace galactic
