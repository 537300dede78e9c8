#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "pack_tool/mesh/grid_mesh.h"
#include "pictures/palette.h"

namespace galactic::pack_tool {

namespace {

static_assert(std::endian::native == std::endian::little, "PLY files are written as they lie");

constexpr std::size_t kCorners = 4;
constexpr pictures::Rgb kCeilingColor{176, 180, 190};

/// The corners counter-clockwise as seen from free space: floors face up, ceilings down.
std::array<Vec3, kCorners> cornersOf(const Patch& patch) {
  const Vec3 a{patch.min_x, patch.y, patch.min_z};
  const Vec3 b{patch.min_x, patch.y, patch.max_z};
  const Vec3 c{patch.max_x, patch.y, patch.max_z};
  const Vec3 d{patch.max_x, patch.y, patch.min_z};
  if (patch.side == Patch::Side::kFloor) return {a, b, c, d};
  return {a, d, c, b};
}

template <class Value>
void appendBytes(std::string& to, Value value) {
  std::array<char, sizeof value> bytes;
  std::memcpy(bytes.data(), &value, sizeof value);
  to.append(bytes.data(), bytes.size());
}

/// Lowest and highest floor.
Span floorRange(const std::vector<Patch>& patches) {
  Span range{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
  for (const Patch& patch : patches) {
    if (patch.side != Patch::Side::kFloor) continue;
    range = {std::min(range.lo, patch.y), std::max(range.hi, patch.y)};
  }
  return range;
}

pictures::Rgb colorOf(const Patch& patch, const Span& range) {
  if (patch.side == Patch::Side::kCeiling) return kCeilingColor;
  if (!(range.hi > range.lo)) return pictures::scaleColor(0);
  return pictures::scaleColor(static_cast<double>((patch.y - range.lo) / (range.hi - range.lo)));
}

void appendObject(std::string& text, const std::vector<Patch>& patches, Patch::Side side,
                  std::size_t& vertices) {
  text += side == Patch::Side::kFloor ? "o floors\n" : "o ceilings\n";
  const std::size_t first = vertices;
  for (const Patch& patch : patches) {
    if (patch.side != side) continue;
    for (const Vec3& corner : cornersOf(patch)) {
      fmt::format_to(std::back_inserter(text), "v {} {} {}\n", corner.x, corner.y, corner.z);
    }
    vertices += kCorners;
  }
  for (std::size_t v = first; v < vertices; v += kCorners) {
    fmt::format_to(std::back_inserter(text), "f {} {} {} {}\n", v + 1, v + 2, v + 3, v + 4);
  }
}

}  // namespace

std::string encodePly(const std::vector<Patch>& patches) {
  std::string file = fmt::format(
      "ply\nformat binary_little_endian 1.0\n"
      "comment free space of a column grid; meters, Y up\n"
      "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      patches.size() * kCorners, patches.size());
  const Span range = floorRange(patches);
  for (const Patch& patch : patches) {
    const pictures::Rgb color = colorOf(patch, range);
    for (const Vec3& corner : cornersOf(patch)) {
      appendBytes(file, corner);
      appendBytes(file, color);
    }
  }
  for (std::size_t p = 0; p < patches.size(); ++p) {
    appendBytes(file, static_cast<std::uint8_t>(kCorners));
    for (std::size_t c = 0; c < kCorners; ++c) {
      appendBytes(file, static_cast<std::int32_t>(p * kCorners + c));
    }
  }
  return file;
}

std::string encodeObj(const std::vector<Patch>& patches) {
  std::string text = "# free space of a column grid; meters, Y up\n";
  std::size_t vertices = 0;
  appendObject(text, patches, Patch::Side::kFloor, vertices);
  appendObject(text, patches, Patch::Side::kCeiling, vertices);
  return text;
}

}  // namespace galactic::pack_tool
