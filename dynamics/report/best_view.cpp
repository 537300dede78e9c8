#include "dynamics/report/best_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "support/try.h"

namespace galactic::dynamics {
namespace {

/// Size in pixels of a picture, and of a trial view.
constexpr std::uint32_t kWidth = 480;
constexpr std::uint32_t kHeight = 360;
constexpr std::uint32_t kLookWidth = 128;
constexpr std::uint32_t kLookHeight = 96;
constexpr float kFov = std::numbers::pi_v<float> / 4;

// Where cameras are tried. Of those that see almost as much as the best one, the first is used.
constexpr std::array kMeters{1.0F, 1.5F};
constexpr std::array kDegreesUp{30.0F, 15.0F, 55.0F};
constexpr int kSides = 12;
constexpr std::size_t kCameras = kMeters.size() * kDegreesUp.size() * kSides;
constexpr float kAlmost = 0.95F;

float lengthOf(const Vec3& v) { return std::sqrt(dot(v, v)); }

/// Cameras all around a ball. The first ones look at right angles to the line from `robot` to the
/// ball, so that an arm reaching for it hides little.
std::vector<RenderCamera> camerasAround(const Vec3& center, float radius, const Vec3& robot) {
  constexpr float kRadians = std::numbers::pi_v<float> / 180;
  const float across =
      std::atan2(center.z - robot.z, center.x - robot.x) + std::numbers::pi_v<float> / 2;
  std::vector<RenderCamera> cameras;
  for (const float meters : kMeters) {
    for (const float degrees : kDegreesUp) {
      for (int side = 0; side < kSides; ++side) {
        const float turn =
            across + static_cast<float>(side) * 2 * std::numbers::pi_v<float> / kSides;
        const float up = degrees * kRadians;
        const Vec3 away{std::cos(up) * std::cos(turn), std::sin(up), std::cos(up) * std::sin(turn)};
        cameras.push_back({lookAt(center + away * (meters + 2 * radius), center), kFov});
      }
    }
  }
  return cameras;
}

/// The corners of a model's bounds, in the frame that it stands in.
std::array<Vec3, 8> cornersOf(const RenderModel& model, const RigidTransform& frame_from_model) {
  std::array<Vec3, 8> corners;
  for (std::size_t n = 0; n < corners.size(); ++n) {
    corners[n] = frame_from_model * Vec3{(n & 1U) != 0 ? model.bounds_max.x : model.bounds_min.x,
                                         (n & 2U) != 0 ? model.bounds_max.y : model.bounds_min.y,
                                         (n & 4U) != 0 ? model.bounds_max.z : model.bounds_min.z};
  }
  return corners;
}

bool isInside(const Vec3& point, const RenderModel& model, const RigidTransform& world_from_model) {
  // Covers what the near plane cuts off.
  constexpr float kMargin = 0.05F;
  const Vec3 p = inverse(world_from_model) * point;
  const auto within = [](float low, float value, float high) {
    return low - kMargin < value && value < high + kMargin;
  };
  return within(model.bounds_min.x, p.x, model.bounds_max.x) &&
         within(model.bounds_min.y, p.y, model.bounds_max.y) &&
         within(model.bounds_min.z, p.z, model.bounds_max.z);
}

/// The share of the pixels of `alone` that are also visible in `among`; both are depths from the
/// same camera.
float shareSeen(std::span<const float> alone, std::span<const float> among) {
  constexpr float kSame = 0.002F;
  std::size_t all = 0;
  std::size_t seen = 0;
  for (std::size_t n = 0; n < alone.size(); ++n) {
    if (alone[n] == 0) continue;
    ++all;
    if (among[n] > alone[n] - kSame) ++seen;
  }
  return all == 0 ? 0 : static_cast<float>(seen) / static_cast<float>(all);
}

RenderView viewOf(const Still& still, const RenderCamera& camera) {
  RenderView view = still.view;
  view.camera = camera;
  view.posed = still.posed;
  view.bodies = still.bodies;
  return view;
}

RenderOptions imageOptions(std::uint32_t width, std::uint32_t height, float near) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.near = near;
  options.backend = RenderBackend::kSoft;
  return options;
}

}  // namespace

Result<std::unique_ptr<BestView>> BestView::create(const World& world,
                                                   const BatchSimulator& simulator) {
  ASSIGN_OR_RETURN(const ChosenCamera follow, chooseCamera(world.robot(), {.name = "follow"}));
  ASSIGN_OR_RETURN(auto models, WorldModels::from(world));
  std::unique_ptr<BestView> view(new BestView(world, std::move(models)));
  const RenderLibrary& library = view->models_.library();
  RenderOptions look = imageOptions(kLookWidth, kLookHeight, follow.near);
  look.color = ColorFormat::kNone;
  // Two views per camera: everything, and the subject alone.
  ASSIGN_OR_RETURN(view->looks_, ImageBatch::create(library, look, 2 * kCameras));
  RenderOptions picture = imageOptions(kWidth, kHeight, follow.near);
  picture.depth = false;
  ASSIGN_OR_RETURN(view->picture_, ImageBatch::create(library, picture, 1));
  view->views_.emplace(view->models_, simulator, follow.mount);
  for (std::size_t link = 0; link < world.robot().links().size(); ++link) {
    view->body_of_link_.push_back(simulator.linkOnBody(link).body);
  }
  return view;
}

Still BestView::take(const BatchSimulator& simulator) {
  views_->update(simulator);
  const RenderView& now = views_->views().front();
  const EnvObjects env = simulator.envObjects(0);
  Still still{.scene = env.scene,
              .view = now,
              .posed = {now.posed.begin(), now.posed.end()},
              .bodies = {now.bodies.begin(), now.bodies.end()},
              .places = {}};
  std::size_t place = 0;
  for (const Placement& placement : env.present.placements) {
    const bool is_shown = models_.objectModel(placement.object).has_value();
    still.places.push_back(is_shown ? std::optional(place++) : std::nullopt);
  }
  return still;
}

Still BestView::withoutRobot(const Still& still, std::size_t object,
                             const Pose& world_from_object) {
  Still other = still;
  other.view.attached = {};
  if (const auto place = other.places[object]) {
    other.posed[*place].world_from_model = world_from_object;
  }
  return other;
}

BestView::Cutout BestView::cutOut(const Still& still, const PictureSubject& subject) const {
  Cutout cutout;
  for (const std::size_t object : subject.objects) {
    if (const auto place = still.places[object]) cutout.posed.push_back(still.posed[*place]);
  }
  if (subject.link) {
    // A link that is a bare frame is shown by what is fixed to it.
    std::vector<AttachedModel> fixed;
    for (std::size_t n = 0; n < still.view.attached.size(); ++n) {
      const AttachedModel& one = still.view.attached[n];
      if (models_.links()[n].link == *subject.link) cutout.attached.push_back(one);
      if (one.body == body_of_link_[*subject.link]) fixed.push_back(one);
    }
    if (cutout.attached.empty()) cutout.attached = std::move(fixed);
  }
  constexpr float kMost = std::numeric_limits<float>::max();
  Vec3 low{kMost, kMost, kMost};
  Vec3 high = low * -1;
  const auto add = [&](std::uint32_t model, const RigidTransform& world_from_model) {
    for (const Vec3& p : cornersOf(models_.library().model(model), world_from_model)) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  };
  for (const PosedModel& one : cutout.posed) add(one.model, rigidTransform(one.world_from_model));
  for (const AttachedModel& one : cutout.attached) {
    add(one.model, still.bodies[one.body] * one.body_from_model);
  }
  if (low.x > high.x) return cutout;
  cutout.center = (low + high) * 0.5F;
  cutout.radius = 0.5F * lengthOf(high - low);
  return cutout;
}

bool BestView::hasPlaceFor(const Vec3& camera, const Still& still) const {
  const ColumnGrid& widest = world_.scenes()[still.scene].grids().back();
  const RenderLibrary& library = models_.library();
  const auto holds_posed = [&](const PosedModel& one) {
    return isInside(camera, library.model(one.model), rigidTransform(one.world_from_model));
  };
  const auto holds_attached = [&](const AttachedModel& one) {
    return isInside(camera, library.model(one.model), still.bodies[one.body] * one.body_from_model);
  };
  return widest.clearance(camera) == Clearance::kFree &&
         std::ranges::none_of(still.posed, holds_posed) &&
         std::ranges::none_of(still.view.attached, holds_attached);
}

std::vector<float> BestView::sharesSeen(const Still& still, const Cutout& cutout,
                                        const std::vector<RenderCamera>& cameras) {
  std::vector<RenderView> views;
  for (const RenderCamera& camera : cameras) {
    views.push_back(viewOf(still, camera));
    RenderView alone = views.back();
    alone.instances = {};
    alone.posed = cutout.posed;
    alone.attached = cutout.attached;
    views.push_back(alone);
  }
  looks_->begin(views);
  looks_->end();
  std::vector<float> shares;
  for (std::size_t n = 0; n < cameras.size(); ++n) {
    const bool has_place = hasPlaceFor(cameras[n].world_from_camera.origin, still);
    const DrawnImage among = looks_->image(2 * n);
    const DrawnImage alone = looks_->image(2 * n + 1);
    shares.push_back(has_place ? shareSeen(alone.depth, among.depth) : 0);
  }
  return shares;
}

std::array<RenderCamera, 2> BestView::camerasFor(const std::array<const Still*, 2>& stills,
                                                 const PictureSubject& subject) {
  // The directions are relative to the robot and subject in the first still, for both stills.
  std::array<std::vector<RenderCamera>, 2> cameras;
  std::vector<float> worth(kCameras);
  Vec3 robot_from_subject;
  for (std::size_t n = 0; n < stills.size(); ++n) {
    const Cutout cutout = cutOut(*stills[n], subject);
    if (n == 0) robot_from_subject = stills[n]->bodies.front().origin - cutout.center;
    cameras[n] = camerasAround(cutout.center, cutout.radius, cutout.center + robot_from_subject);
    const std::vector<float> shares = sharesSeen(*stills[n], cutout, cameras[n]);
    // Seeing half of both is worth more than all of one.
    for (std::size_t k = 0; k < kCameras; ++k) worth[k] += std::sqrt(shares[k]);
  }
  const float best = *std::ranges::max_element(worth);
  if (best == 0) return {stills[0]->view.camera, stills[1]->view.camera};
  const auto first = std::ranges::find_if(worth, [&](float one) { return one >= kAlmost * best; });
  const auto chosen = static_cast<std::size_t>(first - worth.begin());
  return {cameras[0][chosen], cameras[1][chosen]};
}

DrawnImage BestView::draw(const Still& still, const RenderCamera& camera) {
  const RenderView view = viewOf(still, camera);
  picture_->begin(std::span(&view, 1));
  picture_->end();
  return picture_->image(0);
}

}  // namespace galactic::dynamics
