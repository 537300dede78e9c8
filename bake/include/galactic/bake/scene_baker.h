#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/column_engines.h"
#include "galactic/bake/columns.h"
#include "galactic/bake/render_baker.h"
#include "galactic/bake/source_asset.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"

namespace galactic::bake {

/// The method that finds the free spans.
enum class Engine { kExact, kBullet, kEmbree };

struct SceneBakeOptions {
  /// Meters, ascending, 1 to 8 of them.
  std::vector<float> radii{0.015F, 0.05F, 0.12F};
  float spacing = 0.03F;
  Engine engine = Engine::kExact;
  Coverage coverage = Coverage::kColumn;
  FreeSpaceOptions free_space{};
  /// Columns per grid to replay with sphere casts; 0 switches the check off.
  std::uint32_t check_columns = 128;

  friend bool operator==(const SceneBakeOptions&, const SceneBakeOptions&) = default;
};

/// How long each stage took, seconds of wall-clock time.
struct StageTimes {
  double import = 0;
  double clean = 0;
  double columns = 0;
  double regions = 0;
  double encode = 0;
  double check = 0;
  double render = 0;
  double write = 0;
};

/// One grid and its statistics.
struct BakedGrid {
  EncodedGrid grid;
  /// Every component of the free space, by descending volume.
  std::vector<Component> components;
  std::uint64_t raw_spans = 0;
  std::uint64_t merged_gaps = 0;
  std::array<RegionTotals, kRegionCount> totals{};
  std::optional<CastCheck> cast_check;
};

/// Everything in a scene pack but its provenance.
struct BakedScene {
  std::string name;
  ImportStatistics imported;
  Bounds bounds;
  Coverage coverage = Coverage::kColumn;
  std::vector<BakedGrid> grids;
  /// What is drawn, if it is wanted; not made by bakeScene().
  std::optional<BakedRenderMeshes> render_meshes;
  /// What the user should examine: parts of the free space that were left out, and so on.
  std::vector<std::string> warnings;
};

/// A function that is called with the current stage and how far it is (0 to 1), from one thread at
/// a time.
using Progress = std::function<void(std::string_view stage, double fraction)>;

/// Bakes all column grids of one scene. Adds the time of its stages to `times`. Fails with
/// kInvalidInput if options or geometry make a grid impossible; if an option is the cause, the
/// error's `where` is its name in backquotes. The result depends on neither `threads` nor the
/// processor.
[[nodiscard]] Result<BakedScene> bakeScene(const SourceAsset& asset,
                                           const SceneBakeOptions& options, StageTimes& times,
                                           const Progress& progress, unsigned threads = 1);

}  // namespace galactic::bake
