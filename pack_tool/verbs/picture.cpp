#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pack_tool/figure/episode_plans.h"
#include "pack_tool/figure/shared_textures_of.h"
#include "pack_tool/pictures/episode_plan.h"
#include "pack_tool/pictures/figure_picture.h"
#include "pack_tool/pictures/scene_picture.h"
#include "pack_tool/support/open_scene.h"
#include "pack_tool/support/output_file.h"
#include "pack_tool/verbs/verbs.h"
#include "pictures/png_file.h"
#include "support/files/output_files.h"
#include "support/try.h"

namespace galactic::pack_tool {

namespace {

using pictures::Image;

Result<Image> drawGrids(const PackFile& pack, const GridPictureOptions& options,
                        std::optional<int> size) {
  ASSIGN_OR_RETURN(const auto scene, sceneOf(pack));
  ASSIGN_OR_RETURN(const auto grids, gridsOf(scene, pack.where(), options.radius));
  const std::string title = printable(scene.name());
  if (!options.slice) {
    const auto value = options.value.value_or(pictures::PlanValue::kTotalHeight);
    return pictures::drawPlan(grids, {.value = value, .width = size, .title = title}).image;
  }
  pictures::SliceOptions line{.from = options.slice->from, .to = options.slice->to, .title = title};
  line.width = size.value_or(line.width);
  auto slice = pictures::drawSlice(grids, line);
  if (!slice) return fail(slice.error().code, pack.where(), slice.error().message);
  return std::move(slice->image);
}

/// The edge of a view that is asked for, or `usual`.
Result<int> viewSize(const PackFile& pack, const PictureOptions& options, int usual) {
  const int size = options.size.value_or(usual);
  if (size <= pictures::kLargestView) return size;
  return fail(ErrorCode::kInvalidInput, pack.where(),
              fmt::format("found --size {}, expected at most {} for views of meshes, objects and "
                          "robots and for sheets of scenes; only a plan or slice may be larger",
                          size, pictures::kLargestView));
}

Result<Image> drawFigures(const PackFile& pack, const PictureOptions& options,
                          AbsentTextures& absent) {
  ASSIGN_OR_RETURN(const auto figures, figuresOf(pack, options.figures.value_or(FigureOptions{})));
  absent.note(pack, figures.front().render_meshes.get());
  const bool is_one = figures.size() == 1;
  ASSIGN_OR_RETURN(
      const int size,
      viewSize(pack, options, is_one ? pictures::kDefaultViewSize : pictures::kDefaultTileSize));
  if (is_one) return pictures::drawFigure(figures.front(), size);
  auto sheet = pictures::drawContactSheet(figures, size);
  if (!sheet) sheet.error().where = pack.where();
  return sheet;
}

/// Of a scene.
Result<Image> drawMeshes(const PackFile& pack, const PictureOptions& options,
                         AbsentTextures& absent) {
  ASSIGN_OR_RETURN(const auto figures, figuresOf(pack, *options.figures));
  absent.note(pack, figures.front().render_meshes.get());
  ASSIGN_OR_RETURN(const int size, viewSize(pack, options, pictures::kDefaultViewSize));
  auto image = pictures::drawScene(figures.front(), size);
  if (!image) image.error().where = pack.where();
  return image;
}

Result<Image> drawEpisodes(const PackFile& pack, const PictureOptions& options) {
  ASSIGN_OR_RETURN(const auto others, openForPlans(pack, options.trust));
  std::vector<const PackFile*> packs{&pack};
  for (const PackFile& other : others) {
    RETURN_IF_ERROR(checkOutput(other, options.output));
    packs.push_back(&other);
  }
  ASSIGN_OR_RETURN(const auto plans, episodePlansOf(packs, pack.where(),
                                                    {.scene = options.episodes.scene,
                                                     .episode = options.episodes.episode,
                                                     .radius = options.grids.radius}));
  if (plans.size() == 1) {
    const int width = options.size.value_or(pictures::kDefaultEpisodePlan);
    return pictures::drawEpisodePlan(plans.front(), width).image;
  }
  ASSIGN_OR_RETURN(const int size, viewSize(pack, options, pictures::kDefaultTileSize));
  auto sheet = pictures::drawEpisodeSheet(plans, size);
  if (!sheet) sheet.error().where = pack.where();
  return sheet;
}

Result<Image> drawScenePack(const PackFile& pack, const PictureOptions& options,
                            AbsentTextures& absent) {
  if (!options.figures) return drawGrids(pack, options.grids, options.size);
  if (!options.grids.anyGiven()) return drawMeshes(pack, options, absent);
  return fail(ErrorCode::kInvalidInput, pack.where(),
              "is a scene: a picture is either of its grids, with --radius, --slice and --value, "
              "or of its meshes, with --what mesh");
}

bool hasEpisodes(const PackFile& pack) {
  return pack.kind() == PackKind::kWorld || pack.kind() == PackKind::kEpisodes;
}

/// Options that are for other kinds of packs.
Result<void> checkOptions(const PackFile& pack, const PictureOptions& options) {
  const std::string kind = packKindName(pack.kind());
  const auto refuse = [&](std::string_view what) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                fmt::format("is a pack of kind {} and {}", kind, what));
  };
  if (options.episodes.anyGiven() && !hasEpisodes(pack)) {
    return refuse("holds no episodes; --scene and --episode are for worlds and episodes");
  }
  if (pack.kind() == PackKind::kScene) return {};
  if (options.grids.slice || options.grids.value) {
    return refuse("holds no column grids; --slice and --value are for scenes");
  }
  if (options.grids.radius && !hasEpisodes(pack)) {
    return refuse("holds no column grids; --radius is for scenes, worlds and episodes");
  }
  if (options.figures && hasEpisodes(pack)) {
    return refuse(
        "is drawn from above; --object, --joints, --all-zero and --what are for objects, "
        "robots and scenes, one by one");
  }
  return {};
}

Result<Image> draw(const PackFile& pack, const PictureOptions& options, AbsentTextures& absent) {
  RETURN_IF_ERROR(checkOptions(pack, options));
  if (pack.kind() == PackKind::kScene) return drawScenePack(pack, options, absent);
  if (hasEpisodes(pack)) return drawEpisodes(pack, options);
  if (pack.kind() != PackKind::kObjects && pack.kind() != PackKind::kRobot) {
    return fail(
        ErrorCode::kInvalidInput, pack.where(),
        fmt::format("is a pack of kind {}, expected a scene (SCEN), objects (OBJS), a robot "
                    "(RBOT), episodes (EPIS) or a world (WRLD)",
                    packKindName(pack.kind())));
  }
  return drawFigures(pack, options, absent);
}

Result<void> makePicture(const PictureOptions& options, AbsentTextures& absent) {
  RETURN_IF_ERROR(checkExtension(options.output, kPictureFile));
  ASSIGN_OR_RETURN(const auto pack, PackFile::open(options.pack, options.trust));
  ASSIGN_OR_RETURN(const auto image, draw(pack, options, absent));
  RETURN_IF_ERROR(checkOutput(pack, options.output));
  RETURN_IF_ERROR(tryFile(options.output));
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
