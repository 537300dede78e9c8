#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "galactic/pose.h"
#include "galactic/render_meshes.h"
#include "galactic/shapes.h"

namespace galactic::pack_tool {

/// A triangle mesh of a pack: views.
struct SurfaceView {
  /// Meters.
  std::span<const Vec3> positions;
  /// Three corner indices per triangle, counter-clockwise seen from outside.
  std::span<const std::uint32_t> corners;
  /// RGBA, sRGB, 8 bits each, R lowest: one per position, or none.
  std::span<const std::uint32_t> colors;

  [[nodiscard]] bool empty() const { return corners.empty(); }
};

/// A rigid piece of a figure: an object, a link of a robot, or a scene.
struct FigurePart {
  std::string name;
  /// An earlier part that carries this one; -1: none.
  std::int32_t parent = -1;
  Pose world_from_part;
  // In the part's frame; empty where there is none or where it is not shown.
  SurfaceView surface;
  /// In Figure::render_meshes: what is seen instead of the surface, where there is one.
  std::optional<std::uint32_t> render_model;
  std::span<const SetSphere> spheres;
  std::optional<OrientedBox> box;
};

enum class FigureKind { kObject, kRobot, kScene };

/// Where the robot grasps.
struct GraspMark {
  Vec3 center_in_world;
  /// Meters.
  float radius = 0;
};

/// What the robot sees with: looks along +X of its frame, +Y is up in the image.
struct CameraMark {
  Pose world_from_camera;
  /// Radians, between the lower and the upper edge of the image.
  float vertical_fov = 0;
};

/// What the robot covers of the ground: a closed line, meters.
using Footprint = std::vector<Vec3>;

/// An object, a robot in one pose, or a scene, ready to be drawn or exported. Views into the pack
/// it was made from, which must outlive it. World frame: Y up, meters.
struct Figure {
  FigureKind kind = FigureKind::kObject;
  std::string name;
  /// What the spheres are and how good they are, in a few words; and the same in short lines.
  std::string caption;
  std::vector<std::string> short_caption;
  /// Working set, meters: SetSphere::radius_index counts in it.
  std::span<const float> radii;
  /// What the pack has to draw; nullptr for none. Figures of one pack share it.
  std::shared_ptr<const RenderMeshes> render_meshes;
  /// Carriers before what they carry.
  std::vector<FigurePart> parts;
  std::optional<GraspMark> grasp;
  std::optional<CameraMark> camera;
  Footprint footprint;
};

/// An axis-aligned box; empty while min is above max.
struct FigureBounds {
  Vec3 min;
  Vec3 max;

  [[nodiscard]] bool empty() const { return min.x > max.x; }
};

/// The box around everything in `figure`, in the world. Marks do not count.
[[nodiscard]] FigureBounds boundsOf(const Figure& figure);

/// The corners of a box in the frame of its object; corner n lies on the positive side of x, y and
/// z where bits 0, 1 and 2 of n are set.
[[nodiscard]] std::array<Vec3, 8> cornersOf(const OrientedBox& box);

/// The corners of the box around the render model of a part, which has one, in the world.
[[nodiscard]] std::array<Vec3, 8> renderBoxOf(const Figure& figure, const FigurePart& part);

/// The edges of a box as pairs of corners of cornersOf.
inline constexpr std::array<std::pair<int, int>, 12> kBoxEdges{{{0, 1},
                                                                {2, 3},
                                                                {4, 5},
                                                                {6, 7},
                                                                {0, 2},
                                                                {1, 3},
                                                                {4, 6},
                                                                {5, 7},
                                                                {0, 4},
                                                                {1, 5},
                                                                {2, 6},
                                                                {3, 7}}};

/// The four far corners of the pyramid that a camera sees, `length` meters away, in its own frame;
/// images are square.
[[nodiscard]] std::array<Vec3, 4> viewPyramid(const CameraMark& camera, float length);

}  // namespace galactic::pack_tool
