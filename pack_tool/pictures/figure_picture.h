#pragma once
#include <span>

#include "galactic/error.h"
#include "pack_tool/figure/figure.h"
#include "pictures/image.h"

namespace galactic::pictures {

/// Least and largest edge of a view, pixels.
inline constexpr int kSmallestView = 64;
inline constexpr int kLargestView = 2048;

inline constexpr int kDefaultViewSize = 480;
inline constexpr int kDefaultTileSize = 288;

/// Draws a figure from the front, from its right side, from above and from between them, all at one
/// scale, with name, caption, legend and scale bar. Render meshes are
/// drawn as they are, where a pack has them; else meshes of objects are gray, and those of robots
/// have their own colors. `view_size`: edge of each view, kSmallestView to kLargestView pixels.
/// Coordinates must be finite. Safe to call from many threads.
[[nodiscard]] Image drawFigure(const pack_tool::Figure& figure, int view_size = kDefaultViewSize);

/// Draws figures on one sheet, row by row, each at its own scale from between front, side and top,
/// with name, caption and scale bar. Fails with kUnsupported, an empty `where`, when the sheet
/// would have more than 2^28 pixels. `figures` must not be empty. Else as drawFigure.
[[nodiscard]] Result<Image> drawContactSheet(std::span<const pack_tool::Figure> figures,
                                             int view_size = kDefaultTileSize);

}  // namespace galactic::pictures
