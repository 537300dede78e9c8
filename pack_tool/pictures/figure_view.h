#pragma once
#include <optional>

#include "pack_tool/figure/figure.h"
#include "pack_tool/pictures/mesh_raster.h"
#include "pack_tool/pictures/room_cut.h"
#include "pictures/image.h"

namespace galactic::pictures {

// What is drawn in which color: as in figure 3 of the Galactic paper.
inline constexpr Rgb kMeshGray{176, 178, 184};
inline constexpr Rgb kObjectSpheres{46, 116, 232};
inline constexpr Rgb kRobotSpheres{40, 176, 72};
inline constexpr Rgb kBoxEdge{240, 130, 20};
inline constexpr Rgb kGraspMark{214, 30, 140};
inline constexpr Rgb kCameraMark{120, 60, 200};
inline constexpr Rgb kFootprintMark{120, 120, 128};
// Of episodes; people with color-blindness tell them apart.
inline constexpr Rgb kStartMark{0x00, 0x72, 0xb2};
inline constexpr Rgb kTargetMark{0xe6, 0x9f, 0x00};
inline constexpr Rgb kGoalMark{0x00, 0x9e, 0x73};

/// The rectangle that a figure takes along the axes of a view, meters; marks are part of it. Empty
/// while low is above high.
struct ViewWindow {
  double low_right = 0;
  double high_right = 0;
  double low_up = 0;
  double high_up = 0;

  [[nodiscard]] double width() const { return high_right - low_right; }
  [[nodiscard]] double height() const { return high_up - low_up; }
  /// The longer edge; a millimeter where there is nothing.
  [[nodiscard]] double extent() const;
};

[[nodiscard]] ViewWindow windowOf(const pack_tool::Figure& figure, const ViewAxes& axes);

/// The scale at which `meters` fill most of `pixels`.
[[nodiscard]] double fittingScale(double meters, int pixels);

/// Where a view goes: its top left corner, and the length of its edges; pixels.
struct ViewPlace {
  int left = 0;
  int top = 0;
  int size = 0;
};

/// How a figure is looked at.
struct FigureView {
  ViewAxes axes;
  double pixels_per_meter = 1;
  /// What is left out of its render meshes.
  std::optional<RoomCut> cut = std::nullopt;
};

/// Draws a figure into the square `place` of `image`, in its middle.
void drawFigureView(Image& image, const ViewPlace& place, const pack_tool::Figure& figure,
                    const FigureView& view);

}  // namespace galactic::pictures
