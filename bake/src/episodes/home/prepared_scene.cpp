#include "episodes/home/prepared_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "episodes/generation_options.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// How far grids may reach beyond the triangles that they were made of, meters.
constexpr float kGridMargin = 1;

/// The rectangle of a grid; heights are 0.
Bounds groundOf(const ColumnGrid& grid) {
  const ColumnGridLayout& layout = grid.layout();
  const float length = static_cast<float>(layout.columns_x) * layout.spacing;
  const float width = static_cast<float>(layout.columns_z) * layout.spacing;
  return {{layout.min_x, 0, layout.min_z}, {layout.min_x + length, 0, layout.min_z + width}};
}

/// Whether the mesh is about where the grid is. It is not if its up axis or unit differs.
bool covers(const Bounds& mesh, const Bounds& grid) {
  return mesh.min.x <= grid.min.x + kGridMargin && mesh.min.z <= grid.min.z + kGridMargin &&
         mesh.max.x >= grid.max.x - kGridMargin && mesh.max.z >= grid.max.z - kGridMargin;
}

/// Advice for a scene where no goal was found.
std::string adviceFor(const PairSearch& search, float flatness) {
  const RejectionCounts& rejections = search.rejections;
  // On scans nearly every try fails if surfaces have to be flatter than scans are.
  constexpr double kNearlyAll = 0.98;
  const std::uint64_t bumpy =
      rejections[EpisodeRejection::kNoRoom] + rejections[EpisodeRejection::kUneven];
  if (flatness < kScanFlatness && static_cast<double>(bumpy) >= kNearlyAll * kSurveyTries) {
    return fmt::format(
        "hardly any place is flat to {} m under an object and free over it: give scans `flatness` "
        "{}, or ask for other heights or smaller objects",
        flatness, kScanFlatness);
  }
  if (search.reached_targets > 0 || rejections[EpisodeRejection::kNotReached] == 0) {
    return "ask for other distances, other heights or smaller objects";
  }
  return "the hand reached none of the targets that stood: see that the grasp point of the robot's "
         "recipe is outside of its spheres, or ask for other heights or smaller objects";
}

}  // namespace

PreparedScene::PreparedScene(const GenerationContext& context, const Scene& scene,
                             SceneDetails details)
    : context_(context),
      scene_(scene),
      details_(std::move(details)),
      floor_(scene, context.world.robot()),
      supports_(scene, {floor_, context.reach}, details_.receptacles, context.options),
      target_to_goal_(context.options.target_to_goal) {}

Result<std::unique_ptr<const PreparedScene>> PreparedScene::prepare(
    const GenerationContext& context, const Scene& scene, SceneDetails details) {
  std::unique_ptr<PreparedScene> prepared(
      new PreparedScene(context, scene, std::move(details)));  // the constructor is private
  prepared->chooseWay();
  prepared->unusable_ = prepared->whyUnusable();
  if (!prepared->unusable_.empty()) return prepared;
  RETURN_IF_ERROR(prepared->useMesh());
  prepared->survey();
  return prepared;
}

std::string PreparedScene::whyUnusable() const {
  const Robot& robot = context_.world.robot();
  if (floor_.places().empty()) return whyNowhere(floor_, robot);
  if (!supports_.places().empty()) {
    if (target_to_goal_.least <= widestWay()) return {};
    return fmt::format(
        "its surfaces within reach are {:.2f} m apart at most, but goals must be {} m away; ask "
        "for a shorter way from target to goal",
        widestWay(), target_to_goal_.least);
  }
  const bool in_receptacles = context_.options.supports == SupportChoice::kReceptacles;
  if (in_receptacles && details_.receptacles.empty()) {
    return "no receptacles of the scene are known: packs hold none, a recipe that names the "
           "scene's "
           "dataset brings them; or let objects stand on any surface";
  }
  const DistanceRange& heights = context_.options.heights;
  return fmt::format(
      "no flat surface {}between {} and {} m over the floor is within reach of the {} places to "
      "which the robot {} can drive; change `heights`, `flatness` ({} m; scans need some 0.01) or "
      "the robot's start pose, and see that the scene is the right way up",
      in_receptacles ? "in its receptacles " : "", heights.least, heights.most,
      floor_.places().size(), robot.name(), context_.options.flatness);
}

float PreparedScene::widestWay() const {
  // The extents in this many directions give the greatest distance to within a hundredth.
  constexpr int kDirections = 16;
  constexpr float kHundredth = 1.01F;
  const auto extent = [this](const Vec3& direction) {
    float least = std::numeric_limits<float>::max();
    float most = std::numeric_limits<float>::lowest();
    for (const SupportPlace& place : supports_.places()) {
      const float at = dot(direction, {place.x, place.surface, place.z});
      least = std::min(least, at);
      most = std::max(most, at);
    }
    return most - least;
  };
  float across = 0;
  for (int n = 0; n < kDirections; ++n) {
    const float angle = std::numbers::pi_v<float> * static_cast<float>(n) / kDirections;
    across = std::max(across, extent({std::cos(angle), 0, std::sin(angle)}));
  }
  // Origins of objects may be off the centers of their places, and settling moves objects.
  const float off = 2 * (scene_.grids().front().spacing() + kSettlingWay);
  return std::hypot(across * kHundredth, extent({0, 1, 0})) + off;
}

void PreparedScene::chooseWay() {
  // If only the farthest corners are that far apart, hardly any draw finds two of them.
  constexpr float kAmple = 0.75F;
  if (!context_.options.shorten_way || supports_.places().empty()) return;
  const float widest = widestWay();
  if (target_to_goal_.least > kAmple * widest) target_to_goal_.least = widest / 2;
}

void PreparedScene::survey() {
  // Goals closer to their targets than this are hardly a task.
  constexpr float kLeastWay = 0.2F;
  PairSearch search = findProvenPairs(draftHome());
  while (search.pairs.empty() && context_.options.shorten_way &&
         target_to_goal_.least / 2 >= kLeastWay) {
    target_to_goal_.least /= 2;
    search = findProvenPairs(draftHome());
  }
  proven_ = std::move(search.pairs);
  if (!proven_.empty()) return;
  unusable_ = fmt::format(
      "no places were found for a target and its goal {} away{} in {} tries on its {} support "
      "places, which are at most {:.2f} m apart (drawn and not taken: {}); {}",
      textOf(target_to_goal_), context_.options.goal_on_other_support ? " on another surface" : "",
      kSurveyTries, supports_.places().size(), widestWay(), textOf(search.rejections),
      adviceFor(search, context_.options.flatness));
}

Result<void> PreparedScene::useMesh() {
  if (details_.mesh.triangles.empty()) return {};
  const Bounds& mesh = details_.mesh.bounds;
  const Bounds grid = groundOf(scene_.grids().front());
  if (!covers(mesh, grid)) {
    return fail(ErrorCode::kInvalidInput, std::string(scene_.name()),
                fmt::format("the scene's mesh reaches from x {}, z {} to x {}, z {} m, its column "
                            "grids from x {}, z {} to x {}, z {} m; give the mesh it was baked "
                            "from, in the world's frame",
                            mesh.min.x, mesh.min.z, mesh.max.x, mesh.max.z, grid.min.x, grid.min.z,
                            grid.max.x, grid.max.z));
  }
  ASSIGN_OR_RETURN(auto rays, SurfaceRays::build(details_.mesh));
  rays_ = std::make_unique<const SurfaceRays>(std::move(rays));
  settling_ = std::make_unique<const SettlingScene>(details_.mesh);
  // Both have copies of it.
  details_.mesh = {};
  return {};
}

DraftHome PreparedScene::draftHome() const {
  return {.scene = scene_,
          .objects = context_.world.objects(),
          .robot = context_.world.robot(),
          .floor = floor_,
          .reach = context_.reach,
          .supports = supports_,
          .rays = rays_.get(),
          .settling = settling_.get(),
          .bodies = context_.bodies,
          .options = context_.options,
          .target_to_goal = target_to_goal_};
}

std::size_t PreparedScene::bumpyPlaces() const {
  // A few square meters: with more places than this there is room for objects.
  constexpr std::size_t kMany = 2000;
  if (context_.options.flatness >= kScanFlatness || supports_.places().size() > kMany) return 0;
  EpisodeGeneratorOptions options = context_.options;
  options.flatness = kScanFlatness;
  return SupportPlaces(scene_, {floor_, context_.reach}, details_.receptacles, options)
      .places()
      .size();
}

GeneratedScene PreparedScene::summary() const {
  const bool is_shortened = target_to_goal_.least < context_.options.target_to_goal.least;
  return {.name = std::string(scene_.name()),
          .episodes = 0,
          .skipped = 0,
          .floor_places = floor_.places().size(),
          .floor_parts = floor_.parts(),
          .support_places = supports_.places().size(),
          .surfaces = supports_.surfaceCount(),
          .bumpy_places = unusable_.empty() ? bumpyPlaces() : 0,
          .receptacles = details_.receptacles.size(),
          .has_mesh = settling_ != nullptr,
          .shortened_way = is_shortened ? std::optional(target_to_goal_.least) : std::nullopt};
}

}  // namespace galactic::bake
