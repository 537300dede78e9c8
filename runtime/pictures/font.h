#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace galactic::pictures {

inline constexpr int kGlyphWidth = 5;
inline constexpr int kGlyphHeight = 7;
/// How many rows a descending letter reaches below the others.
inline constexpr int kDescent = 2;

/// A character as rows from top to bottom; bit 4 of a row is its leftmost pixel.
using Glyph = std::array<std::uint8_t, kGlyphHeight>;

/// A UTF-8 text as glyphs write it: of a Latin-1 letter its base letters, "?" for each other
/// character beyond ASCII.
[[nodiscard]] std::string lettering(std::string_view text);

/// The glyph of an ASCII character; of '?' for anything else.
[[nodiscard]] const Glyph& glyphOf(char character);

/// Rows by which a character stands lower than the line: kDescent for g, p, q and y, else 0.
[[nodiscard]] int glyphDrop(char character);

}  // namespace galactic::pictures
