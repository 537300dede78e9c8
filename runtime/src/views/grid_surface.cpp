#include "views/grid_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "views/merge_squares.h"

namespace galactic::views {
namespace {

/// The direction in which a face looks; this is the first number of a square's key.
enum Facing : std::int32_t { kUp, kDown, kPlusX, kMinusX, kPlusZ, kMinusZ };

/// As if light came from above and a little from +X.
constexpr std::array<std::uint32_t, 6> kGrays{0xFFBEBEBE, 0xFF6E6E6E, 0xFFA0A0A0,
                                              0xFF828282, 0xFF929292, 0xFF8A8A8A};

/// A free interval of heights, in steps of kHeightStep: low < high.
struct Interval {
  std::int32_t low = 0;
  std::int32_t high = 0;
};

std::int32_t heightSteps(float height) {
  return static_cast<std::int32_t>(std::lround(static_cast<double>(height) / kHeightStep));
}

/// The free intervals of all columns.
class FreeSpace {
 public:
  explicit FreeSpace(const ColumnGrid& grid) : columns_x_(grid.columnsX()) {
    first_.reserve(std::size_t{grid.columnsX()} * grid.columnsZ() + 1);
    std::vector<Span> spans;
    for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
      for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
        first_.push_back(intervals_.size());
        spans.resize(grid.spanCount(i, k));
        grid.spans(i, k, spans);
        addColumn(spans);
      }
    }
    first_.push_back(intervals_.size());
  }

  [[nodiscard]] std::span<const Interval> column(std::uint32_t i, std::uint32_t k) const {
    const std::size_t n = std::size_t{k} * columns_x_ + i;
    return std::span(intervals_).subspan(first_[n], first_[n + 1] - first_[n]);
  }

 private:
  void addColumn(std::span<const Span> spans) {
    const std::size_t first = intervals_.size();
    for (const Span& span : spans) {
      const Interval next{heightSteps(span.lo), heightSteps(span.hi)};
      if (next.low == next.high) continue;
      // Rounding can close the gap between two spans.
      if (intervals_.size() > first && intervals_.back().high >= next.low) {
        intervals_.back().high = next.high;
      } else {
        intervals_.push_back(next);
      }
    }
  }

  std::uint32_t columns_x_;
  std::vector<std::size_t> first_;
  std::vector<Interval> intervals_;
};

/// Calls `face(Interval)` for each interval that is in `here` and not in `there`.
template <class Face>
void eachDifference(std::span<const Interval> here, std::span<const Interval> there,
                    const Face& face) {
  for (const Interval& free : here) {
    std::int32_t low = free.low;
    for (const Interval& other : there) {
      if (other.high <= low || other.low >= free.high) continue;
      if (other.low > low) face(Interval{low, other.low});
      low = std::max(low, other.high);
    }
    if (low < free.high) face(Interval{low, free.high});
  }
}

/// Gathers the faces of all columns.
class FaceGatherer {
 public:
  explicit FaceGatherer(const ColumnGrid& grid)
      : grid_(grid),
        space_(grid),
        lowest_(heightSteps(grid.heights().lo)),
        highest_(heightSteps(grid.heights().hi)) {}

  std::vector<KeyedSquare> gather() {
    for (std::uint32_t k = 0; k < grid_.columnsZ(); ++k) {
      for (std::uint32_t i = 0; i < grid_.columnsX(); ++i) {
        addLevels(i, k);
        if (i + 1 < grid_.columnsX()) addWalls({i, k}, {i + 1, k});
        if (k + 1 < grid_.columnsZ()) addWalls({i, k}, {i, k + 1});
      }
    }
    return std::move(squares_);
  }

 private:
  struct Column {
    std::uint32_t i = 0;
    std::uint32_t k = 0;
  };

  void addLevels(std::uint32_t i, std::uint32_t k) {
    const auto row = static_cast<std::int32_t>(k);
    const auto column = static_cast<std::int32_t>(i);
    for (const Interval& free : space_.column(i, k)) {
      if (free.low > lowest_) squares_.push_back({{kUp, free.low}, row, column});
      if (free.high < highest_) squares_.push_back({{kDown, free.high}, row, column});
    }
  }

  /// Adds the walls between column `a` and its neighbor `b` at +X or +Z.
  void addWalls(const Column& a, const Column& b) {
    const bool along_x = a.i != b.i;
    // Walls in the same line of the grid can be joined along it.
    const auto line = static_cast<std::int32_t>(along_x ? b.i : b.k);
    const auto place = static_cast<std::int32_t>(along_x ? b.k : b.i);
    const auto add = [&](Facing facing) {
      return [this, facing, line, place](const Interval& wall) {
        squares_.push_back({{facing, wall.low, wall.high, line}, 0, place});
      };
    };
    const auto free_a = space_.column(a.i, a.k);
    const auto free_b = space_.column(b.i, b.k);
    eachDifference(free_a, free_b, add(along_x ? kMinusX : kMinusZ));
    eachDifference(free_b, free_a, add(along_x ? kPlusX : kPlusZ));
  }

  const ColumnGrid& grid_;
  FreeSpace space_;
  std::int32_t lowest_;
  std::int32_t highest_;
  std::vector<KeyedSquare> squares_;
};

/// Turns rectangles into triangles in the world frame.
class SurfaceWriter {
 public:
  explicit SurfaceWriter(const ColumnGridLayout& layout) : layout_(layout) {}

  void add(const KeyedRectangle& r) {
    const auto facing = static_cast<Facing>(r.key[0]);
    if (facing == kUp || facing == kDown) {
      const float y = height(r.key[1]);
      const std::array<Vec3, 4> up{{{x(r.first_column), y, z(r.first_row)},
                                    {x(r.first_column), y, z(r.end_row)},
                                    {x(r.end_column), y, z(r.end_row)},
                                    {x(r.end_column), y, z(r.first_row)}}};
      addQuad(up, facing, facing == kDown);
      return;
    }
    const float low = height(r.key[1]);
    const float high = height(r.key[2]);
    if (facing == kPlusX || facing == kMinusX) {
      const float at = x(r.key[3]);
      const std::array<Vec3, 4> plus_x{{{at, low, z(r.first_column)},
                                        {at, high, z(r.first_column)},
                                        {at, high, z(r.end_column)},
                                        {at, low, z(r.end_column)}}};
      addQuad(plus_x, facing, facing == kMinusX);
      return;
    }
    const float at = z(r.key[3]);
    const std::array<Vec3, 4> plus_z{{{x(r.first_column), low, at},
                                      {x(r.end_column), low, at},
                                      {x(r.end_column), high, at},
                                      {x(r.first_column), high, at}}};
    addQuad(plus_z, facing, facing == kMinusZ);
  }

  RenderSurface take() { return std::move(surface_); }

 private:
  [[nodiscard]] float x(std::int32_t cell) const { return edge(layout_.min_x, cell); }
  [[nodiscard]] float z(std::int32_t cell) const { return edge(layout_.min_z, cell); }
  [[nodiscard]] float edge(float minimum, std::int32_t cell) const {
    return static_cast<float>(static_cast<double>(minimum) +
                              cell * static_cast<double>(layout_.spacing));
  }
  static float height(std::int32_t steps) { return static_cast<float>(steps * kHeightStep); }

  /// Adds the corners in the given order or, if `turned`, in reverse order.
  void addQuad(const std::array<Vec3, 4>& corners, Facing facing, bool turned) {
    const auto first = static_cast<std::uint32_t>(surface_.vertices.size());
    for (const Vec3& corner : corners) {
      surface_.vertices.push_back(
          {.position = corner, .color = kGrays[static_cast<std::size_t>(facing)]});
    }
    const std::array<std::uint32_t, 6> order = turned
                                                   ? std::array<std::uint32_t, 6>{0, 2, 1, 0, 3, 2}
                                                   : std::array<std::uint32_t, 6>{0, 1, 2, 0, 2, 3};
    for (const std::uint32_t corner : order) surface_.corners.push_back(first + corner);
  }

  ColumnGridLayout layout_;
  RenderSurface surface_;
};

}  // namespace

RenderSurface gridSurface(const ColumnGrid& grid) {
  SurfaceWriter writer(grid.layout());
  for (const KeyedRectangle& rectangle : mergeSquares(FaceGatherer(grid).gather())) {
    writer.add(rectangle);
  }
  return writer.take();
}

}  // namespace galactic::views
