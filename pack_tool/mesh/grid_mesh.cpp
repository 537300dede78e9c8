#include "pack_tool/mesh/grid_mesh.h"

#include <algorithm>
#include <tuple>

#include "pack_tool/mesh/grid_view.h"

namespace galactic::pack_tool {

namespace {

/// Cells [first_i, end_i) x [first_k, end_k) at one height.
struct CellRect {
  std::uint32_t first_i = 0;
  std::uint32_t end_i = 0;
  std::uint32_t first_k = 0;
  std::uint32_t end_k = 0;
  float y = 0;
  Patch::Side side = Patch::Side::kFloor;

  /// What two rectangles must share to become one along z.
  [[nodiscard]] auto place() const { return std::tuple(first_i, end_i, side, y); }
};

/// Gathers cells row by row into rectangles.
class PatchMerger {
 public:
  /// Adds an end of a span of cell (i, k); cells come row by row.
  void add(std::uint32_t i, std::uint32_t k, float y, Patch::Side side) {
    for (CellRect& run : row_) {
      if (run.end_i == i && run.y == y && run.side == side) {
        run.end_i = i + 1;
        return;
      }
    }
    row_.push_back({i, i + 1, k, k + 1, y, side});
  }

  /// The runs that can no longer grow once all of cell i is added.
  void closeCell(std::uint32_t i) {
    const auto ended = std::stable_partition(
        row_.begin(), row_.end(), [i](const CellRect& run) { return run.end_i == i + 1; });
    finished_row_.insert(finished_row_.end(), ended, row_.end());
    row_.erase(ended, row_.end());
  }

  /// Joins the finished row with the rectangles above it.
  void closeRow() {
    finished_row_.insert(finished_row_.end(), row_.begin(), row_.end());
    row_.clear();
    const auto by_place = [](const CellRect& a, const CellRect& b) {
      return a.place() < b.place();
    };
    std::sort(finished_row_.begin(), finished_row_.end(), by_place);
    auto above = open_.begin();
    for (CellRect& run : finished_row_) {
      while (above != open_.end() && above->place() < run.place()) done_.push_back(*above++);
      if (above != open_.end() && above->place() == run.place()) {
        run.first_k = above->first_k;
        ++above;
      }
    }
    done_.insert(done_.end(), above, open_.end());
    open_.swap(finished_row_);
    finished_row_.clear();
  }

  std::vector<CellRect> finish() {
    done_.insert(done_.end(), open_.begin(), open_.end());
    open_.clear();
    return std::move(done_);
  }

 private:
  /// Runs of the current row that end at the current cell, and those that ended before.
  std::vector<CellRect> row_;
  std::vector<CellRect> finished_row_;
  /// Rectangles that reach down to the row above.
  std::vector<CellRect> open_;
  std::vector<CellRect> done_;
};

std::vector<CellRect> mergedEnds(const ColumnGrid& grid, MeshParts parts) {
  PatchMerger merger;
  std::vector<Span> spans;
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
      readSpans(grid, {i, k}, spans);
      for (const Span& span : spans) {
        merger.add(i, k, span.lo, Patch::Side::kFloor);
        if (parts == MeshParts::kFloors) continue;
        merger.add(i, k, span.hi, Patch::Side::kCeiling);
      }
      merger.closeCell(i);
    }
    merger.closeRow();
  }
  return merger.finish();
}

}  // namespace

std::vector<Patch> gridPatches(const ColumnGrid& grid, const GridMeshOptions& options) {
  const ColumnGridLayout& layout = grid.layout();
  const auto edge = [&layout](float min, std::uint32_t cell) {
    return static_cast<float>(static_cast<double>(min) +
                              cell * static_cast<double>(layout.spacing));
  };
  const float shift = options.height == PatchHeight::kSurface ? layout.radius : 0.0F;
  std::vector<Patch> patches;
  for (const CellRect& rect : mergedEnds(grid, options.parts)) {
    patches.push_back({edge(layout.min_x, rect.first_i), edge(layout.min_x, rect.end_i),
                       edge(layout.min_z, rect.first_k), edge(layout.min_z, rect.end_k),
                       rect.side == Patch::Side::kFloor ? rect.y - shift : rect.y + shift,
                       rect.side});
  }
  return patches;
}

}  // namespace galactic::pack_tool
