#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "galactic/error.h"
#include "pictures/drawing.h"
#include "pictures/image.h"

namespace galactic::pictures {

/// Around sheets and between their tiles, pixels.
inline constexpr int kSheetMargin = 20;

/// What is to be put on a sheet; pixels.
struct SheetContent {
  std::size_t count = 1;
  /// What they are, for the message.
  std::string_view things;
  /// Edge of the view in each tile, for the message.
  int view_size = 0;
  int tile_width = 0;
  int tile_height = 0;
  /// What stands below all tiles.
  int foot_width = 0;
  int foot_height = 0;
};

/// A picture of many things in tiles, row by row, about as many columns as rows.
struct Sheet {
  Image image;
  std::size_t columns = 1;
  int tile_width = 0;
  int tile_height = 0;
  /// Where the foot begins.
  int foot_top = 0;

  /// An empty sheet. Fails with kUnsupported, an empty `where`, when it would have more than 2^28
  /// pixels.
  [[nodiscard]] static Result<Sheet> create(const SheetContent& content);

  /// Where tile `n` goes.
  [[nodiscard]] PixelRect tile(std::size_t n) const;
};

/// The beginning of a text, as much of it as is no wider than `pixels`.
[[nodiscard]] std::string shortened(const std::string& text, int pixels);

/// A name as a title: printable, and cut off where it never ends, as pictures are as wide as it.
[[nodiscard]] std::string titleOf(const std::string& name);

}  // namespace galactic::pictures
