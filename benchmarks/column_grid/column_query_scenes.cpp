#include "column_query_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <stdexcept>

#include "galactic/scene.h"
#include "layout/column_cell.h"

namespace galactic::bench {
namespace {

constexpr float kRadii[] = {0.015F, 0.05F, 0.12F};
constexpr float kCeiling = 2.6F;

/// A rectangle of columns whose spans a piece of furniture or a wall replaces.
struct Block {
  std::uint32_t begin_x, end_x, begin_z, end_z;
  /// Solid slabs in ascending order; nothing but a solid for a wall.
  std::vector<Span> solids;
};

std::uint32_t below(std::mt19937& random, std::uint32_t end) {
  return static_cast<std::uint32_t>(random() % end);
}

/// A rectangle of up to `size` columns somewhere in the grid.
Block rectangle(const test::GridSpec& spec, std::uint32_t size, std::mt19937& random) {
  const std::uint32_t width = size / 2 + below(random, size / 2);
  const std::uint32_t depth = size / 2 + below(random, size / 2);
  const std::uint32_t x = below(random, spec.columns_x - width);
  const std::uint32_t z = below(random, spec.columns_z - depth);
  return {x, x + width, z, z + depth, {}};
}

std::vector<Block> furnishings(const test::GridSpec& spec, std::mt19937& random) {
  std::vector<Block> blocks;
  constexpr int kWalls = 22;
  constexpr int kTables = 26;
  constexpr int kShelves = 7;
  for (int n = 0; n < kWalls; ++n) {
    blocks.push_back(rectangle(spec, 76, random));
    blocks.back().solids = {{-1, kCeiling + 1}};
  }
  for (int n = 0; n < kTables; ++n) {
    blocks.push_back(rectangle(spec, 38, random));
    const float top = 0.4F + 0.4F * static_cast<float>(below(random, 100)) / 100;
    blocks.back().solids = {{top - 0.05F, top}};
  }
  for (int n = 0; n < kShelves; ++n) {
    blocks.push_back(rectangle(spec, 26, random));
    const std::uint32_t boards = 2 + below(random, 6);
    for (std::uint32_t board = 1; board <= boards; ++board) {
      const float height = 0.3F * static_cast<float>(board);
      blocks.back().solids.push_back({height, height + 0.02F});
    }
  }
  return blocks;
}

/// Free heights of a sphere's center between solids.
std::vector<Span> freeSpans(const std::vector<Span>& solids, float radius) {
  std::vector<Span> spans;
  float lo = radius;
  for (const Span& solid : solids) {
    if (solid.lo - radius > lo) spans.push_back({lo, solid.lo - radius});
    lo = solid.hi + radius;
  }
  if (kCeiling - radius > lo) spans.push_back({lo, kCeiling - radius});
  return spans;
}

test::TestGrid furnishedGrid(float radius, const std::vector<Block>& blocks, test::GridSpec spec) {
  spec.radius = radius;
  test::GridBuilder builder(spec);
  for (std::uint32_t k = 0; k < spec.columns_z; ++k) {
    for (std::uint32_t i = 0; i < spec.columns_x; ++i) builder.column(i, k, freeSpans({}, radius));
  }
  for (const Block& block : blocks) {
    for (std::uint32_t k = block.begin_z; k < block.end_z; ++k) {
      for (std::uint32_t i = block.begin_x; i < block.end_x; ++i) {
        builder.column(i, k, freeSpans(block.solids, radius));
      }
    }
  }
  return builder.build();
}

std::size_t overflowCells(const ColumnGrid& grid) {
  const std::uint64_t cells = cellCount(grid.columnsX(), grid.columnsZ());
  return static_cast<std::size_t>(
      std::count_if(grid.layout().cells, grid.layout().cells + cells, isOverflow));
}

/// Elements of the overflow list: the spans of the overflow cells with their end marks.
std::size_t overflowElements(const ColumnGrid& grid) {
  std::size_t elements = overflowCells(grid);
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
      const std::uint32_t cell = cellIndex(i, k, grid.layout().tiles_x);
      if (isOverflow(grid.layout().cells[cell])) elements += grid.spanCount(i, k);
    }
  }
  return elements;
}

/// An overflow span is a pair of codes or a pair of heights.
std::size_t overflowSpanBytes(const ColumnGrid& grid) {
  return grid.layout().overflow_codes == nullptr ? sizeof(Span) : sizeof(std::uint32_t);
}

template <class T>
const T* copyTo(Arena& arena, const T* values, std::size_t count) {
  const std::span<T> copy = arena.take<T>(count);
  std::copy_n(values, count, copy.begin());
  return copy.data();
}

}  // namespace

SceneSource SceneSource::fromPacks(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".pack") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  SceneSource source;
  for (const auto& path : paths) {
    Result<PackFile> pack = PackFile::open(path);
    if (!pack) throw std::runtime_error(pack.error().text());
    const Result<Scene> scene = Scene::from(*pack);
    if (!scene) throw std::runtime_error(scene.error().text());
    source.scenes_.push_back(scene->grids());
    source.packs_.push_back(std::move(*pack));
  }
  if (source.scenes_.empty()) throw std::runtime_error(folder.string() + ": holds no packs");
  return source;
}

SceneSource SceneSource::synthetic() {
  constexpr std::uint32_t kScenes = 7;
  constexpr std::uint32_t kSeed = 7;
  test::GridSpec spec{.radius = kRadii[0],
                      .spacing = 0.03F,
                      .min_x = -2.7F,
                      .min_z = -4.8F,
                      .heights = {-0.1F, 3},
                      .quantum = 9.5e-5F,
                      .columns_x = 250,
                      .columns_z = 440};
  std::mt19937 random(kSeed);
  SceneSource source;
  for (std::uint32_t n = 0; n < kScenes; ++n) {
    const std::vector<Block> blocks = furnishings(spec, random);
    std::vector<test::TestGrid> grids;
    for (const float radius : kRadii) grids.push_back(furnishedGrid(radius, blocks, spec));
    source.made_.push_back(std::move(grids));
  }
  for (const auto& grids : source.made_) {
    SceneGrids views;
    for (const test::TestGrid& grid : grids) views.push_back(grid.view());
    source.scenes_.push_back(std::move(views));
  }
  return source;
}

std::size_t gridBytes(const ColumnGrid& grid) {
  const std::uint64_t cells = cellCount(grid.columnsX(), grid.columnsZ());
  const std::size_t bases = grid.layout().tile_base == nullptr ? 0 : cells / kCellsPerTile;
  return Arena::roomFor(cells * sizeof(std::uint64_t)) +
         Arena::roomFor(bases * sizeof(std::uint16_t)) +
         Arena::roomFor(overflowElements(grid) * overflowSpanBytes(grid));
}

ColumnGrid copyGrid(const ColumnGrid& grid, Arena& arena) {
  ColumnGridLayout layout = grid.layout();
  const std::uint64_t cells = cellCount(grid.columnsX(), grid.columnsZ());
  layout.cells = copyTo(arena, layout.cells, cells);
  if (layout.tile_base != nullptr) {
    layout.tile_base = copyTo(arena, layout.tile_base, cells / kCellsPerTile);
  }
  const std::size_t elements = overflowElements(grid);
  if (layout.overflow_codes != nullptr) {
    layout.overflow_codes = copyTo(arena, layout.overflow_codes, elements);
  } else {
    layout.overflow_spans = copyTo(arena, layout.overflow_spans, elements);
  }
  return ColumnGrid(layout);
}

std::string describe(const std::vector<SceneGrids>& scenes) {
  std::size_t columns = 0;
  std::size_t spans = 0;
  std::size_t overflow = 0;
  for (const SceneGrids& grids : scenes) {
    for (const ColumnGrid& grid : grids) {
      overflow += overflowCells(grid);
      columns += std::size_t{grid.columnsX()} * grid.columnsZ();
      for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
        for (std::uint32_t i = 0; i < grid.columnsX(); ++i) spans += grid.spanCount(i, k);
      }
    }
  }
  const auto all = static_cast<double>(columns);
  return fmt::format("{} different scenes, {:.2f} spans per column, {:.2f} % overflow cells",
                     scenes.size(), static_cast<double>(spans) / all,
                     100 * static_cast<double>(overflow) / all);
}

}  // namespace galactic::bench
