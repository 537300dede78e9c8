#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <span>
#include <string>

#include "galactic/atomic_file.h"
#include "pack_tool/mesh/grid_mesh.h"
#include "pack_tool/open_scene.h"
#include "pack_tool/verbs.h"

namespace galactic::pack_tool {

namespace {

Result<ExportFormat> formatOf(const ExportOptions& options) {
  if (options.format) return *options.format;
  std::string extension = options.output.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".png") return ExportFormat::kPng;
  if (extension == ".obj") return ExportFormat::kObj;
  if (extension == ".ply") return ExportFormat::kPly;
  return fail(ErrorCode::kUnsupported, options.output.string(),
              fmt::format("the extension \"{}\" names no format that can be written; use .png, "
                          ".obj or .ply, or choose one with --to",
                          extension));
}

/// Writing over the pack that is being read would lose it.
Result<void> checkOutput(const OpenScene& open, const ExportOptions& options) {
  std::error_code missing;
  if (!std::filesystem::equivalent(open.pack.where(), options.output, missing)) return {};
  return fail(ErrorCode::kInvalidInput, options.output.string(),
              "is the pack itself; write to another file");
}

Result<void> exportPicture(const OpenScene& open, const std::vector<ColumnGrid>& grids,
                           const ExportOptions& options) {
  const std::string title = printable(open.scene.name());
  if (!options.slice) {
    return pictures::writePng(
        options.output, pictures::drawPlan(grids, {.value = options.value, .title = title}).image);
  }
  const auto picture = pictures::drawSlice(
      grids, {.from = options.slice->from, .to = options.slice->to, .title = title});
  if (!picture) {
    return fail(picture.error().code, open.pack.where(), picture.error().message);
  }
  return pictures::writePng(options.output, picture->image);
}

Result<void> exportMesh(const OpenScene& open, const std::vector<ColumnGrid>& grids,
                        const ExportOptions& options, ExportFormat format) {
  if (grids.size() > 1) {
    std::string radii;
    for (const ColumnGrid& grid : grids) radii += fmt::format(" {}", grid.radius());
    return fail(ErrorCode::kInvalidInput, open.pack.where(),
                fmt::format("has {} grids and a mesh shows one; choose with --radius one of{}",
                            grids.size(), radii));
  }
  const auto patches =
      gridPatches(grids.front(), {.height = options.patch_height, .parts = options.parts});
  if (patches.size() > kMaxPatches) {
    return fail(
        ErrorCode::kUnsupported, open.pack.where(),
        fmt::format("the grid has {} patches and a mesh file holds {}; export --floors-only "
                    "or a pack of larger spacing",
                    patches.size(), kMaxPatches));
  }
  const std::string bytes = format == ExportFormat::kPly ? encodePly(patches) : encodeObj(patches);
  return writeFileAtomically(options.output, {std::as_bytes(std::span(bytes))});
}

Result<void> exportScene(const ExportOptions& options) {
  const auto format = formatOf(options);
  if (!format) return tl::unexpected(format.error());
  const auto open = OpenScene::open(options.pack, options.trust);
  if (!open) return tl::unexpected(open.error());
  const auto grids = open->grids(options.radius);
  if (!grids) return tl::unexpected(grids.error());
  if (auto checked = checkOutput(*open, options); !checked) return checked;
  if (*format == ExportFormat::kPng) return exportPicture(*open, *grids, options);
  return exportMesh(*open, *grids, options, *format);
}

}  // namespace

int runExport(const ExportOptions& options, const Console& console) {
  const auto done = exportScene(options);
  return done ? kExitOk : reportError(console, done.error());
}

}  // namespace galactic::pack_tool
