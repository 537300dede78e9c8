#pragma once
#include <array>
#include <cstdint>

#include "galactic/drawn_number.h"

namespace galactic {

/// What the random numbers of an env's noise are derived from: the same moment gives the same
/// numbers, whatever else is in the batch. An episode that was named has the same numbers in
/// whichever env it is played.
struct EnvMoment {
  /// SimulationOptions::seed, or the seed of the last restart.
  std::uint64_t seed = 0;
  /// Number of the env among the envs of all ranks; 0 in an episode that was named.
  std::uint32_t env = 0;
  /// Steps done in the episode.
  std::uint32_t step = 0;
  /// How many episodes the env has begun; in an episode that was named, its index with all bits
  /// inverted.
  std::uint64_t episode = 0;
};

/// The noise of real cameras, for policies that have to work with them. All off by default. Each
/// number may be a range from which episodes draw.
struct ImageNoise {
  /// Standard deviation of depth at 1 m, meters. It grows with the square of depth, as in sensors
  /// that triangulate (Khoshelham and Elberink 2012).
  DrawnNumber depth_noise = 0;
  /// Fraction of pixels without depth.
  DrawnNumber depth_dropout = 0;
  /// Standard deviation of each color channel, in levels of 255.
  DrawnNumber color_noise = 0;
  /// The colors of an episode are multiplied by a number that is drawn uniformly from 1 - this to 1
  /// + this.
  DrawnNumber light_jitter = 0;

  [[nodiscard]] constexpr bool changesDepth() const {
    return depth_noise.most > 0 || depth_dropout.most > 0;
  }
  [[nodiscard]] constexpr bool changesColor() const {
    return color_noise.most > 0 || light_jitter.most > 0;
  }
};

/// How far a camera's field of view and mounting may deviate from what they should be, differently
/// in each episode. Off by default. Each number may be a range from which episodes draw this limit.
struct CameraJitter {
  /// Either way along each of the camera's axes, meters.
  DrawnNumber camera_jitter = 0;
  /// Either way in roll, pitch and yaw, degrees.
  DrawnNumber camera_jitter_degrees = 0;
  /// Either way in its vertical field of view, degrees.
  DrawnNumber camera_jitter_fov = 0;

  [[nodiscard]] constexpr bool isOn() const {
    return camera_jitter.most > 0 || camera_jitter_degrees.most > 0 || camera_jitter_fov.most > 0;
  }
};

/// A number in `Options` as users know it: from 0, its default, to `most`, or a range within these.
template <class Options>
struct SensorOption {
  /// On command lines with two dashes before it, in Python with '_' in place of '-'.
  const char* name;
  const char* unit;
  const char* text;
  float most;
  DrawnNumber Options::*value;
};

inline constexpr std::array<SensorOption<ImageNoise>, 4> kImageNoiseOptions{{
    {"depth-noise", "METERS", "Standard deviation of depth at 1 m; it grows with depth squared", 1,
     &ImageNoise::depth_noise},
    {"depth-dropout", "SHARE", "Share of the pixels without depth", 1, &ImageNoise::depth_dropout},
    {"color-noise", "LEVELS", "Standard deviation of each channel, in levels of 255", 255,
     &ImageNoise::color_noise},
    {"light-jitter", "SHARE", "By how much an episode may be brighter or darker", 1,
     &ImageNoise::light_jitter},
}};

inline constexpr std::array<SensorOption<CameraJitter>, 3> kCameraJitterOptions{{
    {"camera-jitter", "METERS", "How far the camera may be off along each axis, by episode", 1,
     &CameraJitter::camera_jitter},
    {"camera-jitter-degrees", "DEGREES", "The same of its roll, pitch and yaw", 180,
     &CameraJitter::camera_jitter_degrees},
    {"camera-jitter-fov", "DEGREES", "The same of its vertical field of view", 90,
     &CameraJitter::camera_jitter_fov},
}};

// Checks that every field has an option.
static_assert(sizeof(ImageNoise) == sizeof(DrawnNumber) * kImageNoiseOptions.size());
static_assert(sizeof(CameraJitter) == sizeof(DrawnNumber) * kCameraJitterOptions.size());

}  // namespace galactic
