#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "galactic/pack.h"
#include "pack_tool/export/episode_set_text.h"
#include "pack_tool/figure/figures_of_pack.h"
#include "pack_tool/mesh/grid_view.h"
#include "pack_tool/pictures/pictures.h"
#include "pack_tool/support/console.h"

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
  /// Packs, and folders that are searched for them.
  std::vector<std::filesystem::path> packs = {};
  OutputForm form = OutputForm::kText;
  /// Report for CI systems; empty: none.
  std::filesystem::path junit = {};
  /// 0: one per processor. What is printed does not depend on it.
  unsigned threads = 0;
  /// Whether errors alone are printed; JSON says everything all the same.
  bool is_quiet = false;
};

/// Verifies each pack completely: one line "ok" to console.out or one error with its code (see
/// findingCode) to console.err for each, in the order in which they are given. Of a world pack also
/// the packs that it lists, and whether they fit together.
[[nodiscard]] int runCheck(const CheckOptions& options, const Console& console);

struct ColumnOptions {
  std::filesystem::path pack = {};
  GroundPoint at;
  /// Only the grid of this radius, meters.
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
  /// Lengths that differ by no more than this are equal, meters.
  double tolerance = 0;
  /// Of reports: the share by which numbers may differ; see compareReports.
  std::optional<double> share = std::nullopt;
  DiffScope scope = DiffScope::kEverything;
  OutputForm form = OutputForm::kText;
  Trust trust = Trust::kVerify;
};

/// Compares two packs of one kind by their meaning, or two reports of galactic-bake; kExitDiffers
/// when they differ.
[[nodiscard]] int runDiff(const DiffOptions& options, const Console& console);

/// Two points of the ground plane, the ends of a vertical slice.
struct SliceLine {
  GroundPoint from;
  GroundPoint to;
};

/// What is drawn of a scene's grids.
struct GridPictureOptions {
  /// Only the grid of this radius, meters. Not given: all of them, and the least one below
  /// episodes.
  std::optional<float> radius = std::nullopt;
  /// A slice instead of a plan.
  std::optional<SliceLine> slice = std::nullopt;
  std::optional<pictures::PlanValue> value = std::nullopt;

  [[nodiscard]] bool anyGiven() const { return radius || slice || value; }
};

/// Of which scenes and episodes a plan is drawn.
struct EpisodePictureOptions {
  std::optional<std::string> scene = std::nullopt;
  std::optional<std::uint32_t> episode = std::nullopt;

  [[nodiscard]] bool anyGiven() const { return scene || episode; }
};

struct PictureOptions {
  std::filesystem::path pack = {};
  std::filesystem::path output = {};
  /// For scenes; the radius for worlds and episodes, too.
  GridPictureOptions grids = {};
  /// For objects and robots, and for the render meshes of a scene instead of its grids.
  std::optional<FigureOptions> figures = std::nullopt;
  /// For worlds and episodes.
  EpisodePictureOptions episodes = {};
  /// Edge of a view of meshes, or about the width of a plot of grids; pixels.
  std::optional<int> size = std::nullopt;
  Trust trust = Trust::kVerify;
};

/// Draws a pack into a PNG file, replacing an existing one: the grids of a scene from above or as a
/// slice, or its render meshes, where figures are asked for; a robot or an object from four sides;
/// several objects on a contact sheet; the scenes of a world or of episodes from above, with
/// starts, targets and goals.
[[nodiscard]] int runPicture(const PictureOptions& options, const Console& console);

struct ReportOptions {
  std::vector<std::filesystem::path> packs = {};
  std::filesystem::path output = {};
  Trust trust = Trust::kVerify;
};

/// Writes one self-contained HTML page about packs, those of a world among them: a table, warnings,
/// what runInfo prints, and a picture of every grid and of everything that is drawn.
[[nodiscard]] int runReport(const ReportOptions& options, const Console& console);

struct ViewOptions {
  std::filesystem::path pack = {};
  std::filesystem::path output = {};
  /// Longest edge of a texture on the page, texels: a power of two.
  std::uint32_t texture_size = 512;
  Trust trust = Trust::kVerify;
};

/// Writes one self-contained HTML page that shows a pack in three dimensions, or a world with all
/// its packs. See docs/view.md.
[[nodiscard]] int runView(const ViewOptions& options, const Console& console);

enum class ExportFormat { kObj, kPly, kGlb, kSrdf, kUrdf, kEpisodeSet };

/// How the names of published episode sets end.
inline constexpr std::string_view kEpisodeSetSuffix = ".episode_set.json";

/// Where the patches of an exported mesh lie.
enum class PatchHeight {
  kSphereCenter,  ///< At the ends of the free spans.
  kSurface,       ///< A radius further: where a sphere touches a level surface.
};

/// Which patches an exported mesh has.
enum class MeshParts { kFloorsAndCeilings, kFloors };

struct ExportOptions {
  std::filesystem::path pack = {};
  /// Empty, for episode sets only: NAME.episode_set.json in the current folder for NAME.pack.
  std::filesystem::path output = {};
  /// Not given: by the output's extension.
  std::optional<ExportFormat> format = std::nullopt;
  /// Only the grid of this radius, meters. Not given: the only one. OBJ and PLY.
  std::optional<float> radius = std::nullopt;
  PatchHeight patch_height = PatchHeight::kSphereCenter;
  MeshParts parts = MeshParts::kFloorsAndCeilings;
  /// For GLB.
  std::optional<FigureOptions> figures = std::nullopt;
  /// For episode sets: up axis of the objects' mesh files. Not given: Z.
  std::optional<FileUp> object_up = std::nullopt;
  Trust trust = Trust::kVerify;
};

/// Writes a pack in another format, replacing an existing file: a grid of a scene as a mesh (OBJ,
/// PLY), a scene's render meshes, or objects or a robot with spheres and boxes (GLB), a robot with
/// its spheres (SRDF, URDF), or episodes as a published episode set. Warns on console.err of what
/// an episode set cannot hold.
[[nodiscard]] int runExport(const ExportOptions& options, const Console& console);
/// Which options the file's format cannot heed, and what to do; empty: none, or nothing names a
/// format, which runExport() tells.
[[nodiscard]] std::string exportFault(const ExportOptions& options);

}  // namespace galactic::pack_tool
