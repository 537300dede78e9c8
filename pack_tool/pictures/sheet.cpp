#include "pack_tool/pictures/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "pictures/palette.h"
#include "support/text/printable.h"

namespace galactic::pictures {

namespace {

constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28U;

std::uint64_t pixels(int length) { return static_cast<std::uint64_t>(length); }

}  // namespace

Result<Sheet> Sheet::create(const SheetContent& content) {
  std::uint64_t columns = 1;
  while (columns * columns < content.count) ++columns;
  const std::uint64_t rows = (content.count + columns - 1) / columns;
  const std::uint64_t width =
      std::max(pixels(kSheetMargin) + columns * pixels(content.tile_width + kSheetMargin),
               pixels(2 * kSheetMargin + content.foot_width));
  const std::uint64_t foot_top =
      pixels(kSheetMargin) + rows * pixels(content.tile_height + kSheetMargin);
  const std::uint64_t height = foot_top + pixels(content.foot_height + kSheetMargin);
  if (width > kMostPixels || height > kMostPixels || width * height > kMostPixels) {
    return fail(ErrorCode::kUnsupported, "",
                fmt::format("a sheet of {} {} at {} pixels each has {} x {} pixels, more than "
                            "a picture may have; choose a smaller --size or one of them",
                            content.count, content.things, content.view_size, width, height));
  }
  return Sheet{.image = Image(static_cast<int>(width), static_cast<int>(height), kPaper),
               .columns = static_cast<std::size_t>(columns),
               .tile_width = content.tile_width,
               .tile_height = content.tile_height,
               .foot_top = static_cast<int>(foot_top)};
}

PixelRect Sheet::tile(std::size_t n) const {
  return {kSheetMargin + static_cast<int>(n % columns) * (tile_width + kSheetMargin),
          kSheetMargin + static_cast<int>(n / columns) * (tile_height + kSheetMargin), tile_width,
          tile_height};
}

std::string shortened(const std::string& text, int pixels) {
  if (textWidth(text) <= pixels) return text;
  const auto room = static_cast<std::size_t>(std::max(0, pixels / kTextAdvance - 2));
  return text.substr(0, room) + "..";
}

std::string titleOf(const std::string& name) {
  constexpr int kMostTitle = 1200;
  return shortened(printable(name), kMostTitle);
}

}  // namespace galactic::pictures
