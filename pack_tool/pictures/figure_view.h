#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "pack_tool/figure/figure.h"
#include "pack_tool/pictures/mesh_raster.h"
#include "pack_tool/pictures/room_cut.h"
#include "pictures/image.h"

namespace galactic::pictures {

// What is drawn in which color: as on pages (view/page/), for a picture and a page to be compared.
// People with color-blindness tell them apart.
inline constexpr Rgb kMeshGray{0xb4, 0xb6, 0xba};
/// By the rank of their radius among those in sight, least first; again from the first one where
/// there are more.
inline constexpr std::array<Rgb, 8> kSphereColors{{{0x56, 0xb4, 0xe9},
                                                   {0x00, 0x72, 0xb2},
                                                   {0x00, 0x9e, 0x73},
                                                   {0xcc, 0x79, 0xa7},
                                                   {0xf0, 0xe4, 0x42},
                                                   {0x99, 0x99, 0x99},
                                                   {0xe6, 0x9f, 0x00},
                                                   {0x22, 0x22, 0x22}}};
inline constexpr Rgb kBoxEdge{0xd5, 0x5e, 0x00};
inline constexpr Rgb kGraspMark{0xe6, 0x9f, 0x00};
inline constexpr Rgb kCameraMark{0x00, 0x72, 0xb2};
inline constexpr Rgb kFootprintMark{0xcc, 0x79, 0xa7};
inline constexpr Rgb kStartMark{0x00, 0x72, 0xb2};
inline constexpr Rgb kTargetMark{0xe6, 0x9f, 0x00};
inline constexpr Rgb kGoalMark{0x00, 0x9e, 0x73};

/// The radii of the spheres of figures, ascending, each once: what the ranks of colors count in.
[[nodiscard]] std::vector<float> radiiOf(std::span<const pack_tool::Figure> figures);

/// The color of spheres of the radius of this rank.
[[nodiscard]] constexpr Rgb sphereColor(std::size_t rank) {
  return kSphereColors[rank % kSphereColors.size()];
}

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
  /// As of radiiOf: of all figures in the picture.
  std::span<const float> radii = {};
  /// What is left out of its render meshes.
  std::optional<RoomCut> cut = std::nullopt;
};

/// Draws a figure into the square `place` of `image`, in its middle.
void drawFigureView(Image& image, const ViewPlace& place, const pack_tool::Figure& figure,
                    const FigureView& view);

}  // namespace galactic::pictures
