#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "pictures/image.h"

namespace galactic::pictures {

/// Directions of an orthographic view in the world: unit vectors, right x up = toward the viewer.
struct ViewAxes {
  Vec3 right;
  Vec3 up;
  Vec3 toward;
};

/// From where one looks at an object or robot whose X points forward and Y up.
inline constexpr ViewAxes kFrontView{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
inline constexpr ViewAxes kSideView{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
inline constexpr ViewAxes kTopView{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
/// From the front, to its right and from above.
[[nodiscard]] ViewAxes threeQuarterView();

/// An orthographic window on the world.
struct RasterView {
  ViewAxes axes;
  /// The point of the world in the middle of the picture, metres.
  Vec3 centre;
  double pixels_per_metre = 1;
  /// Pixels.
  int width = 1;
  int height = 1;
};

/// A mesh to draw, in its own frame.
struct RasterMesh {
  std::span<const Vec3> positions;
  /// Three per triangle; both sides are seen.
  std::span<const std::uint32_t> corners;
  /// RGBA, R lowest: one per position, or none for `colour`.
  std::span<const std::uint32_t> colors;
  Rgb colour;
};

/// A sphere in the world, metres.
struct RasterSphere {
  Vec3 centre;
  float radius = 0;
};

/// A straight line in the world, metres.
struct RasterLine {
  Vec3 from;
  Vec3 to;
  Rgb colour;
};

/// Draws opaque meshes, translucent spheres and lines with a depth buffer, four samples per pixel.
/// Meshes and spheres may come in any order; spheres form one translucent shell. Lines shine
/// faintly through meshes. Coordinates must be finite.
class MeshRaster {
 public:
  explicit MeshRaster(const RasterView& view);

  void drawMesh(const RasterMesh& mesh, const Pose& world_from_mesh);
  void drawSphere(const RasterSphere& sphere, Rgb colour);
  void drawLine(const RasterLine& line);

  /// Puts the picture into `image`, its top left corner at (left, top).
  void compose(Image& image, int left, int top) const;

 private:
  /// A point in samples: x to the right, y down, depth towards the viewer in metres.
  struct Sample {
    double x = 0;
    double y = 0;
    double depth = 0;
  };

  /// One thing per sample: its colour and how near it is.
  struct Layer {
    std::vector<Rgb> colours;
    std::vector<float> depths;
  };

  struct SamplePlace {
    int x = 0;
    int y = 0;
  };

  [[nodiscard]] Sample project(const Vec3& point) const;
  [[nodiscard]] std::size_t indexOf(SamplePlace place) const;
  void drawTriangle(const std::array<Sample, 3>& corners, Rgb colour);
  /// Colours a sample of `layer` unless something nearer is there.
  void plot(Layer& layer, SamplePlace place, double depth, Rgb colour) const;
  void plotLine(const RasterLine& line, std::vector<Rgb>& samples) const;

  RasterView view_;
  int width_;
  int height_;
  double samples_per_metre_;
  Layer mesh_;
  Layer spheres_;
  std::vector<RasterLine> lines_;
};

}  // namespace galactic::pictures
