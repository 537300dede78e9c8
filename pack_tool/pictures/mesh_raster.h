#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "galactic/pose.h"
#include "layout/render_mesh_builder.h"
#include "pack_tool/pictures/room_cut.h"
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
  /// The point of the world in the middle of the picture, meters.
  Vec3 center;
  double pixels_per_meter = 1;
  /// Pixels.
  int width = 1;
  int height = 1;
};

/// A mesh to draw, in its own frame.
struct RasterMesh {
  std::span<const Vec3> positions;
  /// Three per triangle; both sides are seen.
  std::span<const std::uint32_t> corners;
  /// RGBA, R lowest: one per position, or none for `color`.
  std::span<const std::uint32_t> colors;
  Rgb color;
};

/// A sphere in the world, meters.
struct RasterSphere {
  Vec3 center;
  float radius = 0;
};

/// A straight line in the world, meters.
struct RasterLine {
  Vec3 from;
  Vec3 to;
  Rgb color;
};

/// Draws opaque meshes, translucent spheres and lines, four samples per pixel. Meshes and spheres
/// are drawn by the soft backend of BatchRenderer, through a lens so long that the view is parallel
/// to half a pixel. They may come in any order; spheres form one translucent shell. Lines shine
/// faintly through meshes. Coordinates must be finite; triangles far outside the view are left out.
class MeshRaster {
 public:
  explicit MeshRaster(const RasterView& view);

  /// Cuts the render models that are drawn from now on: rooms are seen without their ceilings, and
  /// what the cut goes through is dark, with an outline.
  void openRooms(const RoomCut& cut);

  void drawMesh(const RasterMesh& mesh, const Pose& world_from_mesh);
  /// With materials and textures. What has no light of its own in the colors of its vertices is
  /// shaded so that its shape is seen. `meshes` outlives this.
  void drawRenderModel(const RenderMeshes& meshes, const RenderModel& model,
                       const Pose& world_from_model);
  void drawSphere(const RasterSphere& sphere, Rgb color);
  void drawLine(const RasterLine& line);

  /// Puts the picture into `image`, its top left corner at (left, top).
  void compose(Image& image, int left, int top) const;

 private:
  /// A point in samples: x to the right, y down, depth towards the viewer in units of the view.
  struct Sample {
    double x = 0;
    double y = 0;
    double depth = 0;
  };

  /// One thing per sample: its color and how near it is.
  struct Layer {
    std::vector<Rgb> colors;
    std::vector<float> depths;
  };

  struct SamplePlace {
    int x = 0;
    int y = 0;
  };

  /// Where a point of the world is in the frame that is drawn: X away from the viewer, Y up, Z to
  /// the right, in units of a few samples.
  [[nodiscard]] Vec3 inView(const Vec3& point) const;
  [[nodiscard]] Sample project(const Vec3& point) const;
  [[nodiscard]] std::size_t indexOf(SamplePlace place) const;
  /// `least_light`: what is left of a color in the shadow; 1: nothing is shaded.
  void addTriangle(RenderSurface& to, std::array<RenderVertex, 3> corners,
                   double least_light) const;
  /// `height` of the cut in the world.
  void drawSection(std::span<const SectionLine> section, float height);
  /// The first material of a pack among those of the picture.
  std::size_t firstMaterialOf(const RenderMeshes& meshes);
  /// The meshes and the spheres as images.
  [[nodiscard]] std::array<Layer, 2> render() const;
  void plotLine(const RasterLine& line, const Layer& meshes, std::vector<Rgb>& samples) const;

  RasterView view_;
  int width_;
  int height_;
  double samples_per_meter_;
  /// From the viewer to the middle of the picture, units.
  double distance_;
  /// Part 0: meshes; part 1: spheres.
  RenderMeshSource source_;
  /// Packs whose materials are in source_, and where.
  std::vector<std::pair<const RenderMeshes*, std::size_t>> packs_;
  std::vector<RasterLine> lines_;
  std::optional<RoomCut> cut_;
};

}  // namespace galactic::pictures
