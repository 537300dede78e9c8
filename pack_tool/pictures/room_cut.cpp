#include "pack_tool/pictures/room_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

namespace galactic::pictures {

namespace {

/// Of the length of a normal: within 18 degrees of level.
constexpr float kLevel = 0.95F;

Vec3 normalOf(const std::array<RenderVertex, 3>& corners) {
  return cross(corners[1].position - corners[0].position,
               corners[2].position - corners[0].position);
}

std::array<RenderVertex, 3> triangleOf(const RenderSurface& surface, std::size_t first_corner) {
  const auto at = [&](std::size_t n) {
    return surface.vertices[surface.corners[first_corner + n]];
  };
  return {at(0), at(1), at(2)};
}

bool isCeiling(const RoomCut& cut, const std::array<RenderVertex, 3>& corners) {
  const auto above = [&cut](const RenderVertex& v) { return v.position.y > cut.level; };
  if (!std::ranges::all_of(corners, above)) return false;
  const Vec3 normal = normalOf(corners);
  return std::abs(normal.y) > kLevel * std::sqrt(dot(normal, normal));
}

/// The vertex on the way from `a` to `b` that is at a height between theirs.
RenderVertex vertexBetween(const RenderVertex& a, const RenderVertex& b, float height) {
  const float share = (height - a.position.y) / (b.position.y - a.position.y);
  const auto mix = [share](float x, float y) { return x + (y - x) * share; };
  RenderVertex vertex{.position = a.position + (b.position - a.position) * share,
                      .u = mix(a.u, b.u),
                      .v = mix(a.v, b.v),
                      .color = 0};
  vertex.position.y = height;
  for (unsigned shift = 0; shift < 32; shift += 8) {
    const auto channel = [shift](std::uint32_t color) {
      return static_cast<float>(color >> shift & 255U);
    };
    vertex.color |= static_cast<std::uint32_t>(std::lround(mix(channel(a.color), channel(b.color))))
                    << shift;
  }
  return vertex;
}

/// What is left of a triangle below a height, in its turn: no corner, or three or four.
struct LowerPart {
  std::array<RenderVertex, 4> corners;
  std::size_t count = 0;
  /// Where the triangle was cut.
  std::optional<SectionLine> section;
};

LowerPart partBelow(const std::array<RenderVertex, 3>& triangle, float height) {
  LowerPart part;
  std::array<Vec3, 2> ends;
  std::size_t end_count = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    const RenderVertex& from = triangle[n];
    const RenderVertex& to = triangle[(n + 1) % 3];
    const bool is_below = from.position.y <= height;
    if (is_below) part.corners[part.count++] = from;
    if (is_below == (to.position.y <= height)) continue;
    const RenderVertex crossing = vertexBetween(from, to, height);
    part.corners[part.count++] = crossing;
    // First where the outline of the triangle goes up, then where it comes down.
    ends[is_below ? 0 : 1] = crossing.position;
    ++end_count;
  }
  if (end_count == 2) part.section = SectionLine{ends[0].x, ends[0].z, ends[1].x, ends[1].z};
  return part;
}

/// Of faces that look up, by their heights.
class AreaByHeight {
 public:
  AreaByHeight(float low, float high)
      : low_(low), step_(std::max(kStep, (high - low) / kMostSteps)), areas_(kMostSteps + 2) {}

  void add(float height, float area) {
    areas_[static_cast<std::size_t>((height - low_) / step_)] += static_cast<double>(area);
  }

  /// The lowest one with about as much area as the largest; the lowest height where no face covers
  /// much of the ground.
  [[nodiscard]] float floor(double ground) const {
    constexpr double kAbout = 0.5;
    constexpr double kLeastOfGround = 0.25;
    // A floor may lie on both sides of where a step begins.
    const auto area = [this](std::size_t n) { return areas_[n] + areas_[n + 1]; };
    double largest = 0;
    for (std::size_t n = 0; n + 1 < areas_.size(); ++n) largest = std::max(largest, area(n));
    if (largest < kLeastOfGround * ground) return low_;
    std::size_t lowest = 0;
    while (area(lowest) < kAbout * largest) ++lowest;
    if (areas_[lowest] < areas_[lowest + 1]) ++lowest;
    return low_ + static_cast<float>(lowest) * step_;
  }

 private:
  /// Meters.
  static constexpr float kStep = 0.1F;
  static constexpr std::size_t kMostSteps = 1000;

  float low_;
  float step_;
  std::vector<double> areas_;
};

/// A raster of cells over a section, row by row: rows along X, one after the other along Z.
struct SectionRaster {
  double low_x = 0;
  double low_z = 0;
  double cell = 1;
  std::size_t columns = 0;
  std::size_t rows = 0;

  [[nodiscard]] std::size_t cells() const { return columns * rows; }
};

/// How many more outer sides than inner ones a ray has passed before the middle of each cell; the
/// last entry of each line is for what lies behind all cells.
struct Crossings {
  std::vector<int> sums;
  std::size_t line_length = 0;

  Crossings(std::size_t lines, std::size_t cells)
      : sums(lines * (cells + 1)), line_length(cells + 1) {}

  /// A piece of the section, from (along, across) to another such point, in cells. `inward`: 1
  /// where rays go in through pieces that lead to higher `across`, -1 where they come out.
  void add(std::array<double, 2> from, std::array<double, 2> to, int inward) {
    const bool is_rising = from[1] < to[1];
    if (!is_rising) std::swap(from, to);
    const auto first = static_cast<std::size_t>(std::max(0.0, std::ceil(from[1] - 0.5)));
    for (std::size_t line = first; static_cast<double>(line) + 0.5 < to[1]; ++line) {
      const double share = (static_cast<double>(line) + 0.5 - from[1]) / (to[1] - from[1]);
      const double along = from[0] + share * (to[0] - from[0]);
      const auto cell = static_cast<std::size_t>(
          std::clamp(std::ceil(along - 0.5), 0.0, static_cast<double>(line_length - 1)));
      if (line * line_length + cell < sums.size()) {
        sums[line * line_length + cell] += is_rising ? inward : -inward;
      }
    }
  }

  void sumUp() {
    for (std::size_t n = 0; n < sums.size(); ++n) {
      if (n % line_length != 0) sums[n] += sums[n - 1];
    }
  }

  /// Of the two directions of a line, how many find a cell inside.
  [[nodiscard]] int votes(std::size_t line, std::size_t cell) const {
    const int before = sums[line * line_length + cell];
    const int all = sums[line * line_length + line_length - 1];
    return (before > 0 ? 1 : 0) + (before > all ? 1 : 0);
  }
};

SectionRaster rasterOf(std::span<const SectionLine> section, double cell) {
  constexpr float kFar = std::numeric_limits<float>::max();
  SectionRect box{kFar, kFar, -kFar, -kFar};
  for (const SectionLine& line : section) {
    box.low_x = std::min({box.low_x, line.from_x, line.to_x});
    box.low_z = std::min({box.low_z, line.from_z, line.to_z});
    box.high_x = std::max({box.high_x, line.from_x, line.to_x});
    box.high_z = std::max({box.high_z, line.from_z, line.to_z});
  }
  const auto count = [cell](float low, float high) {
    constexpr double kMost = 1e9;
    const double length = static_cast<double>(high) - static_cast<double>(low);
    // Of no lines at all, it is below 0.
    return static_cast<std::size_t>(std::max(0.0, std::min(std::ceil(length / cell), kMost)));
  };
  return {static_cast<double>(box.low_x), static_cast<double>(box.low_z), cell,
          count(box.low_x, box.high_x), count(box.low_z, box.high_z)};
}

/// One for each cell: 1 inside of a solid.
std::vector<std::uint8_t> insideCells(std::span<const SectionLine> section,
                                      const SectionRaster& raster) {
  Crossings along_x(raster.rows, raster.columns);
  Crossings along_z(raster.columns, raster.rows);
  const auto in_cells = [&raster](float x, float z) {
    return std::array{(static_cast<double>(x) - raster.low_x) / raster.cell,
                      (static_cast<double>(z) - raster.low_z) / raster.cell};
  };
  for (const SectionLine& line : section) {
    const auto from = in_cells(line.from_x, line.from_z);
    const auto to = in_cells(line.to_x, line.to_z);
    along_x.add(from, to, -1);
    along_z.add({from[1], from[0]}, {to[1], to[0]}, 1);
  }
  along_x.sumUp();
  along_z.sumUp();
  std::vector<std::uint8_t> inside(raster.cells());
  for (std::size_t n = 0; n < inside.size(); ++n) {
    const std::size_t row = n / raster.columns;
    const std::size_t column = n % raster.columns;
    constexpr int kMost = 3;
    inside[n] = along_x.votes(row, column) + along_z.votes(column, row) >= kMost ? 1 : 0;
  }
  return inside;
}

/// Sums over squares of cells.
class SquareSums {
 public:
  SquareSums(std::span<const std::uint8_t> cells, const SectionRaster& raster)
      : raster_(raster), sums_((raster.columns + 1) * (raster.rows + 1)) {
    for (std::size_t row = 0; row < raster.rows; ++row) {
      for (std::size_t column = 0; column < raster.columns; ++column) {
        sums_[at(column + 1, row + 1)] = sums_[at(column, row + 1)] + sums_[at(column + 1, row)] -
                                         sums_[at(column, row)] +
                                         cells[row * raster.columns + column];
      }
    }
  }

  /// Of the cells of [first, end) in both directions, as far as there are any.
  [[nodiscard]] std::uint32_t sum(std::array<std::size_t, 2> first,
                                  std::array<std::size_t, 2> end) const {
    end = {std::min(end[0], raster_.columns), std::min(end[1], raster_.rows)};
    return sums_[at(end[0], end[1])] - sums_[at(first[0], end[1])] - sums_[at(end[0], first[1])] +
           sums_[at(first[0], first[1])];
  }

 private:
  [[nodiscard]] std::size_t at(std::size_t column, std::size_t row) const {
    return row * (raster_.columns + 1) + column;
  }

  SectionRaster raster_;
  std::vector<std::uint32_t> sums_;
};

/// Leaves out the cells of squares of this many cells that lie wholly inside.
void leaveOutWide(std::vector<std::uint8_t>& inside, const SectionRaster& raster,
                  std::size_t width) {
  const SquareSums filled(inside, raster);
  std::vector<std::uint8_t> begins(inside.size());
  for (std::size_t n = 0; n < inside.size(); ++n) {
    const std::array first{n % raster.columns, n / raster.columns};
    const std::array end{first[0] + width, first[1] + width};
    begins[n] = filled.sum(first, end) == width * width ? 1 : 0;
  }
  const SquareSums wide(begins, raster);
  for (std::size_t n = 0; n < inside.size(); ++n) {
    const std::array last{n % raster.columns, n / raster.columns};
    const auto begin = [width](std::size_t cell) { return cell + 1 - std::min(cell + 1, width); };
    if (wide.sum({begin(last[0]), begin(last[1])}, {last[0] + 1, last[1] + 1}) > 0) inside[n] = 0;
  }
}

}  // namespace

RoomCut floorPlanCut(std::span<const RenderSurface> surfaces) {
  constexpr float kFar = std::numeric_limits<float>::max();
  Vec3 low{kFar, kFar, kFar};
  Vec3 high = low * -1;
  for (const RenderSurface& surface : surfaces) {
    for (const RenderVertex& vertex : surface.vertices) {
      const Vec3& p = vertex.position;
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  AreaByHeight floors(low.y, high.y);
  for (const RenderSurface& surface : surfaces) {
    for (std::size_t n = 0; n + 2 < surface.corners.size(); n += 3) {
      const auto corners = triangleOf(surface, n);
      const Vec3 normal = normalOf(corners);
      const float up = surface.two_sided ? std::abs(normal.y) : normal.y;
      if (!(up > kLevel * std::sqrt(dot(normal, normal)))) continue;
      const Vec3 middle =
          (corners[0].position + corners[1].position + corners[2].position) * (1.0F / 3);
      floors.add(std::clamp(middle.y, low.y, high.y), 0.5F * up);
    }
  }
  constexpr float kAboveFloor = 1.2F;
  constexpr float kShare = 0.6F;
  const Vec3 size = high - low;
  const float floor = floors.floor(static_cast<double>(size.x) * static_cast<double>(size.z));
  const float height = floor + std::min(kAboveFloor, kShare * (high.y - floor));
  return {height, height};
}

void cutThrough(const RoomCut& cut, RenderSurface& surface, std::vector<SectionLine>& section) {
  std::vector<std::uint32_t> kept;
  kept.reserve(surface.corners.size());
  for (std::size_t n = 0; n + 2 < surface.corners.size(); n += 3) {
    const auto triangle = triangleOf(surface, n);
    if (isCeiling(cut, triangle)) continue;
    const LowerPart part = partBelow(triangle, cut.height);
    if (!part.section) {
      if (part.count > 0)
        kept.insert(kept.end(),
                    {surface.corners[n], surface.corners[n + 1], surface.corners[n + 2]});
      continue;
    }
    section.push_back(*part.section);
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    surface.vertices.insert(surface.vertices.end(), part.corners.begin(),
                            part.corners.begin() + static_cast<std::ptrdiff_t>(part.count));
    for (std::uint32_t corner = 2; corner < part.count; ++corner) {
      kept.insert(kept.end(), {first, first + corner - 1, first + corner});
    }
  }
  surface.corners = std::move(kept);
}

std::vector<SectionRect> filledSection(std::span<const SectionLine> section, double cell) {
  constexpr std::size_t kMostCells = std::size_t{1} << 24U;
  /// Meters.
  constexpr double kWidest = 1;
  std::vector<SectionRect> rects;
  const SectionRaster raster = rasterOf(section, cell);
  if (section.empty() || raster.cells() > kMostCells) return rects;
  std::vector<std::uint8_t> inside = insideCells(section, raster);
  leaveOutWide(inside, raster, static_cast<std::size_t>(std::ceil(kWidest / cell)));
  const auto x_of = [&](std::size_t n) {
    return static_cast<float>(raster.low_x + static_cast<double>(n) * cell);
  };
  const auto z_of = [&](std::size_t n) {
    return static_cast<float>(raster.low_z + static_cast<double>(n) * cell);
  };
  for (std::size_t row = 0; row < raster.rows; ++row) {
    const std::uint8_t* const cells = inside.data() + row * raster.columns;
    for (std::size_t begin = 0; begin < raster.columns; ++begin) {
      if (cells[begin] == 0) continue;
      std::size_t end = begin;
      while (end < raster.columns && cells[end] != 0) ++end;
      rects.push_back({x_of(begin), z_of(row), x_of(end), z_of(row + 1)});
      begin = end;
    }
  }
  return rects;
}

}  // namespace galactic::pictures
