#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "galactic/episode_set.h"
#include "pack_tool/export/robot_text.h"
#include "pack_tool/figure/shared_textures_of.h"
#include "pack_tool/mesh/figure_glb.h"
#include "pack_tool/mesh/grid_mesh.h"
#include "pack_tool/support/open_scene.h"
#include "pack_tool/support/output_file.h"
#include "pack_tool/verbs/verbs.h"
#include "support/files/output_files.h"
#include "support/try.h"

namespace galactic::pack_tool {

namespace {

Result<ExportFormat> formatOf(const ExportOptions& options) {
  if (options.format) return *options.format;
  const std::string extension = extensionOf(options.output);
  if (options.output.filename().string().ends_with(kEpisodeSetSuffix)) {
    return ExportFormat::kEpisodeSet;
  }
  if (extension == ".obj") return ExportFormat::kObj;
  if (extension == ".ply") return ExportFormat::kPly;
  if (extension == ".glb") return ExportFormat::kGlb;
  if (extension == ".srdf") return ExportFormat::kSrdf;
  if (extension == ".urdf") return ExportFormat::kUrdf;
  if (extension == ".png") {
    return fail(ErrorCode::kUnsupported, options.output.string(),
                "is a picture; draw it with galactic-pack picture");
  }
  return fail(ErrorCode::kUnsupported, options.output.string(),
              fmt::format("the extension \"{}\" names no format that can be written; use .glb, "
                          ".srdf, .urdf, .obj, .ply or .episode_set.json, or choose one with --to",
                          extension));
}

Result<std::string> gridMesh(const PackFile& pack, const ExportOptions& options,
                             ExportFormat format) {
  if (pack.kind() == PackKind::kEpisodes) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                "is a pack of kind EPIS and holds no column grids, which OBJ and PLY files show; "
                "export it --to episode_set");
  }
  if (pack.kind() == PackKind::kObjects || pack.kind() == PackKind::kRobot) {
    return fail(
        ErrorCode::kInvalidInput, pack.where(),
        fmt::format("is a pack of kind {} and holds no column grids, which OBJ and PLY files "
                    "show; export it --to glb",
                    packKindName(pack.kind())));
  }
  ASSIGN_OR_RETURN(const auto scene, sceneOf(pack));
  ASSIGN_OR_RETURN(const auto grids, gridsOf(scene, pack.where(), options.radius));
  if (grids.size() > 1) {
    std::string radii;
    for (const ColumnGrid& grid : grids) radii += fmt::format(" {}", grid.radius());
    return fail(ErrorCode::kInvalidInput, pack.where(),
                fmt::format("has {} grids and a mesh shows one; choose with --radius one of{}",
                            grids.size(), radii));
  }
  const auto patches =
      gridPatches(grids.front(), {.height = options.patch_height, .parts = options.parts});
  if (patches.size() > kMaxPatches) {
    return fail(
        ErrorCode::kUnsupported, pack.where(),
        fmt::format("the grid has {} patches and a mesh file holds {}; export --floors-only "
                    "or a pack of larger spacing",
                    patches.size(), kMaxPatches));
  }
  return format == ExportFormat::kPly ? encodePly(patches) : encodeObj(patches);
}

Result<std::string> figureScene(const PackFile& pack, const ExportOptions& options,
                                AbsentTextures& absent) {
  ASSIGN_OR_RETURN(auto figures, figuresOf(pack, options.figures.value_or(FigureOptions{})));
  absent.note(pack, figures.front().render_meshes.get());
  // A single object stays in its own frame.
  if (figures.size() > 1) layOutInARow(figures);
  auto bytes = encodeGlb(figures);
  if (!bytes) bytes.error().where = pack.where();
  return bytes;
}

Result<std::string> robotDescription(const PackFile& pack, ExportFormat format) {
  ASSIGN_OR_RETURN(const auto robot, Robot::from(pack));
  return format == ExportFormat::kSrdf ? srdfText(robot) : spherizedUrdfText(robot);
}

Result<std::string> publishedEpisodes(const PackFile& pack, const ExportOptions& options) {
  ASSIGN_OR_RETURN(const auto set, EpisodeSet::from(pack));
  return episodeSetText(set, options.object_up.value_or(FileUp::kZ));
}

Result<std::string> encode(const PackFile& pack, const ExportOptions& options, ExportFormat format,
                           AbsentTextures& absent) {
  switch (format) {
    case ExportFormat::kEpisodeSet:
      return publishedEpisodes(pack, options);
    case ExportFormat::kGlb:
      return figureScene(pack, options, absent);
    case ExportFormat::kSrdf:
    case ExportFormat::kUrdf:
      return robotDescription(pack, format);
    case ExportFormat::kObj:
    case ExportFormat::kPly:
      break;
  }
  return gridMesh(pack, options, format);
}

/// "tidy.episode_set.json" for "packs/tidy.pack", where no other file is named.
std::filesystem::path outputOf(const ExportOptions& options) {
  if (!options.output.empty()) return options.output;
  return options.pack.stem().concat(kEpisodeSetSuffix);
}

Result<void> exportPack(const ExportOptions& options, AbsentTextures& absent) {
  ASSIGN_OR_RETURN(const auto format, formatOf(options));
  ASSIGN_OR_RETURN(const auto pack, PackFile::open(options.pack, options.trust));
  ASSIGN_OR_RETURN(const auto bytes, encode(pack, options, format, absent));
  const std::filesystem::path output = outputOf(options);
  if (auto checked = checkOutput(pack, output); !checked) return checked;
  return writeOutput(output, bytes);
}

}  // namespace

std::string exportFault(const ExportOptions& options) {
  const Result<ExportFormat> format = formatOf(options);
  if (!format) return {};
  if (options.figures && *format != ExportFormat::kGlb) {
    return "--object, --joints, --all-zero and --what are for GLB files; leave them out";
  }
  if (options.object_up && *format != ExportFormat::kEpisodeSet) {
    return "--object-up is for episode sets; leave it out";
  }
  const bool grid = *format == ExportFormat::kObj || *format == ExportFormat::kPly;
  const bool patches = options.radius || options.patch_height != PatchHeight::kSphereCenter ||
                       options.parts != MeshParts::kFloorsAndCeilings;
  if (patches && !grid) {
    return "--radius, --surface and --floors-only are for OBJ and PLY files; leave them out";
  }
  return {};
}

int runExport(const ExportOptions& options, const Console& console) {
  AbsentTextures absent;
  const auto done = exportPack(options, absent);
  if (!done) return reportError(console, done.error());
  reportWarning(console, absent.warning());
  return kExitOk;
}

}  // namespace galactic::pack_tool
