#include "pack_tool/report/thumbnails.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "galactic/scene.h"
#include "galactic/schema/pack_generated.h"
#include "pack_tool/figure/episode_plans.h"
#include "pack_tool/figure/figures_of_pack.h"
#include "pack_tool/pictures/episode_plan.h"
#include "pack_tool/pictures/figure_picture.h"
#include "pack_tool/pictures/pictures.h"
#include "pack_tool/pictures/scene_picture.h"
#include "pack_tool/support/open_scene.h"
#include "pictures/png_file.h"
#include "support/text/printable.h"
#include "support/try.h"

namespace galactic::pack_tool {
namespace {

using pictures::Image;

constexpr int kPlanWidth = 360;
constexpr int kViewSize = 200;
/// Of a set with more objects there are several sheets: a picture of thousands is more than one may
/// be, and than anybody looks at.
constexpr std::size_t kMostOnSheet = 240;
constexpr std::size_t kMostPlansOnSheet = 60;

Result<Thumbnail> encoded(std::string caption, const Image& image) {
  ASSIGN_OR_RETURN(auto png, pictures::encodePng(image));
  return Thumbnail{std::move(caption), image.width(), image.height(), std::move(png)};
}

Result<void> addPlans(const Scene& scene, std::vector<Thumbnail>& thumbnails) {
  for (const ColumnGrid& grid : scene.grids()) {
    const auto plan = pictures::drawPlan(std::span(&grid, 1),
                                         {.width = kPlanWidth, .title = printable(scene.name())});
    ASSIGN_OR_RETURN(auto thumbnail,
                     encoded(fmt::format("free height, radius {:g} m", grid.radius()), plan.image));
    thumbnails.push_back(std::move(thumbnail));
  }
  return {};
}

/// A part of the figures of a pack, as one picture.
Result<Image> drawn(std::span<const Figure> figures) {
  if (figures.front().kind == FigureKind::kScene) {
    return pictures::drawScene(figures.front(), kViewSize);
  }
  if (figures.size() > 1) return pictures::drawContactSheet(figures, kViewSize);
  return pictures::drawFigure(figures.front(), kViewSize);
}

bool hasFigures(const PackFile& pack) {
  const schema::Scene* scene = pack.root().asset_as_Scene();
  if (scene != nullptr) return scene->render_meshes() != nullptr;
  return pack.kind() == PackKind::kObjects || pack.kind() == PackKind::kRobot;
}

std::string sheetCaption(std::size_t first, std::size_t count, std::size_t all) {
  if (count == all) return "as it is drawn";
  return fmt::format("as it is drawn, {} to {} of {}", first + 1, first + count, all);
}

Result<void> addFigures(const PackFile& pack, AbsentTextures& absent,
                        std::vector<Thumbnail>& thumbnails) {
  FigureOptions options;
  if (pack.kind() == PackKind::kScene) {
    options.layers = LayerSet::none();
    options.layers.add(FigureLayer::kMesh);
  }
  ASSIGN_OR_RETURN(const auto figures, figuresOf(pack, options));
  absent.note(pack, figures.front().render_meshes.get());
  const std::span<const Figure> all(figures);
  for (std::size_t first = 0; first < all.size(); first += kMostOnSheet) {
    const auto some = all.subspan(first, std::min(kMostOnSheet, all.size() - first));
    ASSIGN_OR_RETURN(const auto image, drawn(some));
    ASSIGN_OR_RETURN(auto thumbnail, encoded(sheetCaption(first, some.size(), all.size()), image));
    thumbnails.push_back(std::move(thumbnail));
  }
  return {};
}

/// Of the packs of a page, the one of this number and the scenes, the nearest first: a page may be
/// about several worlds with scenes of one name.
std::vector<const PackFile*> withScenes(std::span<const PackFile> packs, std::size_t number) {
  std::vector<std::size_t> scenes;
  for (std::size_t n = 0; n < packs.size(); ++n) {
    if (packs[n].kind() == PackKind::kScene) scenes.push_back(n);
  }
  std::ranges::stable_sort(
      scenes, {}, [number](std::size_t n) { return n < number ? number - n : n - number; });
  std::vector<const PackFile*> chosen{&packs[number]};
  for (const std::size_t n : scenes) chosen.push_back(&packs[n]);
  return chosen;
}

Result<void> addEpisodes(std::span<const PackFile> packs, std::size_t number,
                         std::vector<Thumbnail>& thumbnails) {
  ASSIGN_OR_RETURN(auto plans, episodePlansOf(withScenes(packs, number), packs[number].where()));
  std::erase_if(plans, [](const pictures::EpisodePlan& plan) { return plan.episodes.empty(); });
  const std::span<const pictures::EpisodePlan> all(plans);
  for (std::size_t first = 0; first < all.size(); first += kMostPlansOnSheet) {
    const auto some = all.subspan(first, std::min(kMostPlansOnSheet, all.size() - first));
    ASSIGN_OR_RETURN(const auto image, pictures::drawEpisodeSheet(some, kPlanWidth));
    const std::string caption = some.size() == all.size()
                                    ? "starts, targets and goals"
                                    : fmt::format("starts, targets and goals, plans {} to {} of {}",
                                                  first + 1, first + some.size(), all.size());
    ASSIGN_OR_RETURN(auto thumbnail, encoded(caption, image));
    thumbnails.push_back(std::move(thumbnail));
  }
  return {};
}

}  // namespace

Result<std::vector<Thumbnail>> thumbnailsOf(std::span<const PackFile> packs, std::size_t number,
                                            AbsentTextures& absent) {
  const PackFile& pack = packs[number];
  std::vector<Thumbnail> thumbnails;
  if (hasFigures(pack)) {
    RETURN_IF_ERROR(addFigures(pack, absent, thumbnails));
  }
  if (pack.kind() == PackKind::kEpisodes) {
    RETURN_IF_ERROR(addEpisodes(packs, number, thumbnails));
  }
  if (pack.kind() == PackKind::kScene) {
    ASSIGN_OR_RETURN(const auto scene, sceneOf(pack));
    RETURN_IF_ERROR(addPlans(scene, thumbnails));
  }
  return thumbnails;
}

}  // namespace galactic::pack_tool
