#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "column_query_arena.h"
#include "galactic/column_grid.h"
#include "galactic/pack.h"
#include "inspect/query_workload.h"
#include "support/packs/grid_builder.h"

namespace galactic::bench {

/// The different scenes to measure on: from packs, or made up.
class SceneSource {
 public:
  /// The scenes of all packs in `folder`, in the order of their names. Throws std::runtime_error
  /// when one cannot be read or there is none.
  static SceneSource fromPacks(const std::filesystem::path& folder);

  /// Room-like scenes of 250 x 440 columns and three radii: floors, walls, furniture with space
  /// under it, shelves with many boards. About 0.8 spans per column, 2 % overflow cells.
  static SceneSource synthetic();

  [[nodiscard]] const std::vector<SceneGrids>& scenes() const { return scenes_; }

 private:
  std::vector<PackFile> packs_;
  std::vector<std::vector<test::TestGrid>> made_;
  std::vector<SceneGrids> scenes_;
};

/// Bytes that a copy of `grid` takes of an arena.
[[nodiscard]] std::size_t gridBytes(const ColumnGrid& grid);

/// Copies all that a query on `grid` reads into `arena`.
[[nodiscard]] ColumnGrid copyGrid(const ColumnGrid& grid, Arena& arena);

/// Spans per column and share of overflow cells over all scenes, as a sentence.
[[nodiscard]] std::string describe(const std::vector<SceneGrids>& scenes);

}  // namespace galactic::bench
