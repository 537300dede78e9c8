#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "galactic/pack.h"
#include "pack_tool/console.h"
#include "pack_tool/grid_view.h"
#include "pack_tool/pictures/pictures.h"

namespace galactic::pack_tool {

// The verbs of galactic-pack. Each runs to its end, reports what is wrong to console.err and
// returns the exit code.

enum class OutputForm { kText, kJson };

struct InfoOptions {
  std::vector<std::filesystem::path> packs = {};
  OutputForm form = OutputForm::kText;
  Trust trust = Trust::kVerify;
};

/// Prints what is in each pack. JSON is an array with one object per readable pack.
[[nodiscard]] int runInfo(const InfoOptions& options, const Console& console);

struct CheckOptions {
  std::vector<std::filesystem::path> packs = {};
  OutputForm form = OutputForm::kText;
};

/// Verifies each pack completely: one line "ok" to console.out or one error to console.err for
/// each.
[[nodiscard]] int runCheck(const CheckOptions& options, const Console& console);

struct ColumnOptions {
  std::filesystem::path pack = {};
  GroundPoint at;
  /// Only the grid of this radius, metres.
  std::optional<float> radius = std::nullopt;
  OutputForm form = OutputForm::kText;
  Trust trust = Trust::kVerify;
};

/// Prints the free spans of the column nearest to a point.
[[nodiscard]] int runColumn(const ColumnOptions& options, const Console& console);

/// What two packs must agree in to be equal.
enum class DiffScope {
  kEverything,  ///< Provenance and statistics too.
  kContent,     ///< What the runtime reads: bounds, grids, spans.
};

struct DiffOptions {
  std::filesystem::path a = {};
  std::filesystem::path b = {};
  /// Lengths that differ by no more than this are equal, metres.
  double tolerance = 0;
  DiffScope scope = DiffScope::kEverything;
  OutputForm form = OutputForm::kText;
  Trust trust = Trust::kVerify;
};

/// Compares two scene packs by their meaning; kExitDiffers when they differ.
[[nodiscard]] int runDiff(const DiffOptions& options, const Console& console);

enum class ExportFormat { kPng, kObj, kPly };

/// Two points of the ground plane, the ends of a vertical slice.
struct SliceLine {
  GroundPoint from;
  GroundPoint to;
};

/// Where the patches of an exported mesh lie.
enum class PatchHeight {
  kSphereCentre,  ///< At the ends of the free spans.
  kSurface,       ///< A radius further: where a sphere touches a level surface.
};

/// Which patches an exported mesh has.
enum class MeshParts { kFloorsAndCeilings, kFloors };

struct ExportOptions {
  std::filesystem::path pack = {};
  std::filesystem::path output = {};
  /// Not given: by the output's extension.
  std::optional<ExportFormat> format = std::nullopt;
  /// Only the grid of this radius, metres. Not given: all of them (pictures), or the only one.
  std::optional<float> radius = std::nullopt;
  /// A slice instead of a plan; pictures only.
  std::optional<SliceLine> slice = std::nullopt;
  pictures::PlanValue value = pictures::PlanValue::kTotalHeight;
  PatchHeight patch_height = PatchHeight::kSphereCentre;
  MeshParts parts = MeshParts::kFloorsAndCeilings;
  Trust trust = Trust::kVerify;
};

/// Writes a picture or a mesh of a grid, replacing an existing file.
[[nodiscard]] int runExport(const ExportOptions& options, const Console& console);

}  // namespace galactic::pack_tool
