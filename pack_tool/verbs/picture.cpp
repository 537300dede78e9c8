#include <fmt/format.h>

#include <string>

#include "pack_tool/figure/shared_textures_of.h"
#include "pack_tool/pictures/figure_picture.h"
#include "pack_tool/pictures/scene_picture.h"
#include "pack_tool/support/open_scene.h"
#include "pack_tool/support/output_file.h"
#include "pack_tool/verbs/verbs.h"
#include "pictures/png_file.h"
#include "support/output_files.h"
#include "support/try.h"

namespace galactic::pack_tool {

namespace {

using pictures::Image;

Result<Image> drawGrids(const PackFile& pack, const GridPictureOptions& options) {
  ASSIGN_OR_RETURN(const auto scene, sceneOf(pack));
  ASSIGN_OR_RETURN(const auto grids, gridsOf(scene, pack.where(), options.radius));
  const std::string title = printable(scene.name());
  if (!options.slice) {
    const auto value = options.value.value_or(pictures::PlanValue::kTotalHeight);
    return pictures::drawPlan(grids, {.value = value, .title = title}).image;
  }
  auto slice = pictures::drawSlice(
      grids, {.from = options.slice->from, .to = options.slice->to, .title = title});
  if (!slice) return fail(slice.error().code, pack.where(), slice.error().message);
  return std::move(slice->image);
}

Result<Image> drawFigures(const PackFile& pack, const PictureOptions& options,
                          AbsentTextures& absent) {
  ASSIGN_OR_RETURN(const auto figures, figuresOf(pack, options.figures.value_or(FigureOptions{})));
  absent.note(pack, figures.front().render_meshes.get());
  if (figures.size() == 1) {
    return pictures::drawFigure(figures.front(), options.size.value_or(pictures::kDefaultViewSize));
  }
  auto sheet =
      pictures::drawContactSheet(figures, options.size.value_or(pictures::kDefaultTileSize));
  if (!sheet) sheet.error().where = pack.where();
  return sheet;
}

/// Of a scene.
Result<Image> drawMeshes(const PackFile& pack, const PictureOptions& options,
                         AbsentTextures& absent) {
  ASSIGN_OR_RETURN(const auto figures, figuresOf(pack, *options.figures));
  absent.note(pack, figures.front().render_meshes.get());
  auto image =
      pictures::drawScene(figures.front(), options.size.value_or(pictures::kDefaultViewSize));
  if (!image) image.error().where = pack.where();
  return image;
}

Result<Image> draw(const PackFile& pack, const PictureOptions& options, AbsentTextures& absent) {
  if (pack.kind() == PackKind::kScene) {
    if (!options.figures && !options.size) return drawGrids(pack, options.grids);
    if (options.figures && !options.grids.anyGiven()) return drawMeshes(pack, options, absent);
    return fail(ErrorCode::kInvalidInput, pack.where(),
                "is a scene: a picture is either of its grids, with --radius, --slice and --value, "
                "or of its meshes, with --what mesh and --size");
  }
  if (!options.grids.anyGiven()) return drawFigures(pack, options, absent);
  return fail(ErrorCode::kInvalidInput, pack.where(),
              fmt::format("is a pack of kind {} and holds no column grids; --radius, --slice and "
                          "--value are for scenes",
                          packKindName(pack.kind())));
}

Result<void> makePicture(const PictureOptions& options, AbsentTextures& absent) {
  RETURN_IF_ERROR(checkExtension(options.output, kPictureFile));
  ASSIGN_OR_RETURN(const auto pack, PackFile::open(options.pack, options.trust));
  ASSIGN_OR_RETURN(const auto image, draw(pack, options, absent));
  if (auto checked = checkOutput(pack, options.output); !checked) return checked;
  return pictures::writePng(options.output, image);
}

}  // namespace

int runPicture(const PictureOptions& options, const Console& console) {
  AbsentTextures absent;
  const auto done = makePicture(options, absent);
  if (!done) return reportError(console, done.error());
  reportWarning(console, absent.warning());
  return kExitOk;
}

}  // namespace galactic::pack_tool
