#include "pack_tool/pictures/scene_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "galactic/batch_renderer.h"
#include "galactic/render_library.h"
#include "pack_tool/pictures/axes.h"
#include "pack_tool/pictures/figure_view.h"
#include "pack_tool/pictures/sheet.h"
#include "pictures/palette.h"
#include "support/try.h"
#include "view/render_surfaces.h"

namespace galactic::pictures {

namespace {

using pack_tool::Figure;

constexpr int kMargin = 20;
constexpr int kLine = kTextHeight + 10;
/// Samples along each edge of a pixel.
constexpr std::size_t kSamples = 2;
constexpr std::size_t kInsideViews = 2;

constexpr float kFov = std::numbers::pi_v<float> / 2;

/// Places on a grid over the ground, each with views along +X, -Z, -X and +Z.
std::vector<RenderCamera> candidates(const RenderModel& model) {
  constexpr int kPlaces = 7;
  // Meters; of low scenes, this share of their height.
  constexpr float kEyes = 1.5F;
  constexpr float kEyeShare = 0.6F;
  constexpr float kHalf = 0.707106781F;
  constexpr std::array<Quat, 4> kTurns{
      {{0, 0, 0, 1}, {0, kHalf, 0, kHalf}, {0, 1, 0, 0}, {0, -kHalf, 0, kHalf}}};
  const Vec3& low = model.bounds_min;
  const Vec3 size = model.bounds_max - low;
  std::vector<RenderCamera> cameras;
  cameras.reserve(kTurns.size() * kPlaces * kPlaces);
  for (int n = 0; n < kPlaces * kPlaces; ++n) {
    const int column = n % kPlaces;
    const int row = n / kPlaces;
    const Vec3 eye{low.x + size.x * (static_cast<float>(column) + 0.5F) / kPlaces,
                   low.y + std::min(kEyes, kEyeShare * size.y),
                   low.z + size.z * (static_cast<float>(row) + 0.5F) / kPlaces};
    for (const Quat& turn : kTurns) cameras.push_back({rigidTransform({eye, turn}), kFov});
  }
  return cameras;
}

/// How much room a view shows: its mean depth, meters, counted up to a few; nothing where something
/// stands right before the eye. `depths`: 0 where nothing is.
double roomIn(std::span<const float> depths) {
  constexpr double kFar = 6;
  constexpr float kNear = 0.7F;
  constexpr std::size_t kMostNearShare = 20;
  std::size_t near = 0;
  double sum = 0;
  for (const float depth : depths) {
    if (depth > 0 && depth < kNear) ++near;
    sum += std::min(static_cast<double>(depth), kFar);
  }
  return near > depths.size() / kMostNearShare ? 0 : sum / static_cast<double>(depths.size());
}

/// The two views with the most room, in different directions.
Result<std::array<RenderCamera, kInsideViews>> insideCameras(const RenderLibrary& library,
                                                             const RenderInstance& scene) {
  RenderOptions options;
  options.width = options.height = 24;
  options.color = ColorFormat::kNone;
  options.backend = RenderBackend::kSoft;
  ASSIGN_OR_RETURN(auto renderer, BatchRenderer::create(library, options));
  const std::vector<RenderCamera> cameras = candidates(library.model(scene.model));
  std::vector<RenderView> views;
  views.reserve(cameras.size());
  for (const RenderCamera& camera : cameras) views.push_back({camera, {&scene, 1}});
  const std::size_t pixels = std::size_t{options.width} * options.height;
  std::vector<float> depths(views.size() * pixels);
  renderer.render(views, {.color = {}, .depth = depths, .semantics = {}});
  // Of each direction; the first one where they are equal.
  std::array<std::pair<double, std::size_t>, 4> best{{{0, 0}, {0, 1}, {0, 2}, {0, 3}}};
  for (std::size_t n = 0; n < views.size(); ++n) {
    const double room = roomIn(std::span(depths).subspan(n * pixels, pixels));
    auto& [most, view] = best[n % best.size()];
    if (room <= most) continue;
    most = room;
    view = n;
  }
  std::ranges::stable_sort(best, std::greater{}, [](const auto& one) { return one.first; });
  return std::array<RenderCamera, kInsideViews>{cameras[best[0].second], cameras[best[1].second]};
}

/// What hides the rooms of a scene that is seen from outside: over doors and furniture, under lamps
/// and beams; of lower rooms the ceiling.
RoomCut ceilingsOf(const Figure& scene) {
  constexpr float kAnyShare = 0.8F;
  constexpr float kLevelShare = 0.6F;
  const pack_tool::FigureBounds bounds = boundsOf(scene);
  const float height = bounds.max.y - bounds.min.y;
  return {bounds.min.y + kAnyShare * height, bounds.min.y + kLevelShare * height};
}

RoomCut planCutOf(const Figure& scene) {
  const pack_tool::FigurePart& part = scene.parts.front();
  const RenderMeshes& meshes = *scene.render_meshes;
  std::vector<RenderSurface> surfaces = surfacesOf(meshes, meshes.models[*part.render_model]);
  for (RenderSurface& surface : surfaces) {
    for (RenderVertex& vertex : surface.vertices) {
      vertex.position = part.world_from_part * vertex.position;
    }
  }
  return floorPlanCut(surfaces);
}

/// The mean of the samples of each pixel.
void place(Image& image, const ViewPlace& view, std::span<const std::uint8_t> samples) {
  const auto size = static_cast<std::size_t>(view.size);
  const std::size_t row = 3 * kSamples * size;
  for (std::size_t y = 0; y < size; ++y) {
    for (std::size_t x = 0; x < size; ++x) {
      std::array<unsigned, 3> sum{};
      for (std::size_t s = 0; s < kSamples * kSamples; ++s) {
        const std::size_t at =
            (kSamples * y + s / kSamples) * row + 3 * (kSamples * x + s % kSamples);
        for (std::size_t channel = 0; channel < 3; ++channel) sum[channel] += samples[at + channel];
      }
      const auto mean = [](unsigned total) {
        constexpr unsigned kCount = kSamples * kSamples;
        return static_cast<std::uint8_t>((total + kCount / 2) / kCount);
      };
      image.set(view.left + static_cast<int>(x), view.top + static_cast<int>(y),
                {mean(sum[0]), mean(sum[1]), mean(sum[2])});
    }
  }
}

Result<void> drawInside(Image& image, const std::array<ViewPlace, kInsideViews>& places,
                        const Figure& scene) {
  RenderLibrary library;
  library.add(*scene.render_meshes);
  RenderOptions options;
  options.width = options.height =
      static_cast<std::uint32_t>(kSamples) * static_cast<std::uint32_t>(places[0].size);
  options.color = ColorFormat::kRgb8;
  options.depth = false;
  options.background = 0xFFFFFFFF;
  options.backend = RenderBackend::kSoft;
  ASSIGN_OR_RETURN(auto renderer, BatchRenderer::create(library, options));
  const std::uint32_t model = *scene.parts.front().render_model;
  const std::array instance{RenderInstance{.model = model, .world_from_model = {}}};
  ASSIGN_OR_RETURN(const auto cameras, insideCameras(library, instance.front()));
  const std::array views{RenderView{cameras[0], instance}, RenderView{cameras[1], instance}};
  const std::size_t bytes = std::size_t{3} * options.width * options.height;
  std::vector<std::uint8_t> samples(kInsideViews * bytes);
  renderer.render(views, {.color = samples, .depth = {}, .semantics = {}});
  for (std::size_t n = 0; n < kInsideViews; ++n) {
    place(image, places[n], std::span(samples).subspan(n * bytes, bytes));
  }
  return {};
}

}  // namespace

Result<Image> drawScene(const Figure& scene, int view_size) {
  constexpr std::array<std::string_view, 4> kNames{"from above", "three-quarter", "inside",
                                                   "inside"};
  std::array<FigureView, 2> outside{{{.axes = kTopView, .cut = planCutOf(scene)},
                                     {.axes = threeQuarterView(), .cut = ceilingsOf(scene)}}};
  double extent = 0;
  for (const FigureView& view : outside) {
    extent = std::max(extent, windowOf(scene, view.axes).extent());
  }
  const double scale = fittingScale(extent, view_size);
  for (FigureView& view : outside) view.pixels_per_meter = scale;
  const std::string name = titleOf(scene.name);
  const int width = 2 * kMargin + std::max(4 * (view_size + kMargin) - kMargin, textWidth(name));
  const int top = kMargin + 2 * kLine;
  Image image(width, top + view_size + kMargin + kLine + kMargin, kPaper);
  drawText(image, {kMargin, kMargin}, name, kInk);
  std::array<ViewPlace, 4> places;
  for (std::size_t n = 0; n < places.size(); ++n) {
    places[n] = {kMargin + static_cast<int>(n) * (view_size + kMargin), top, view_size};
    drawText(image, {places[n].left + view_size / 2, kMargin + kLine, Anchor::kCenter}, kNames[n],
             kInk);
    if (n < outside.size()) drawFigureView(image, places[n], scene, outside[n]);
  }
  RETURN_IF_ERROR(drawInside(image, {places[2], places[3]}, scene));
  for (const ViewPlace& view : places) {
    drawFrame(image, {view.left, view.top, view.size, view.size}, kFaintInk);
  }
  drawScaleBar(image, {kMargin, top + view_size + kMargin}, scale, view_size / 2);
  return image;
}

}  // namespace galactic::pictures
