#include "episodes/episode_draft.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "episodes/reach_witness.h"

namespace galactic::bake {
namespace {

constexpr std::size_t kDrafts = 20;
constexpr std::size_t kObjectTries = 300;
constexpr std::size_t kStartTries = 300;
constexpr float kTurn = 2 * std::numbers::pi_v<float>;

using BodySpheres = std::vector<BodySphere>;

/// A stable pose, each as likely as drops end in it.
const StablePose& drawStablePose(const ObjectModel& model, Random& random) {
  float total = 0;
  for (const StablePose& pose : model.stable_poses) total += pose.likelihood;
  float left = static_cast<float>(random.unit()) * total;
  for (const StablePose& pose : model.stable_poses) {
    left -= pose.likelihood;
    if (left < 0) return pose;
  }
  return model.stable_poses.front();
}

/// An object on a support surface, and the floor from which that is reached.
struct Draw {
  PlacedObject object;
  float floor = 0;
};

/// One draft of an episode: what stands where so far.
class Draft {
 public:
  Draft(const Stage& stage, Random& random) : stage_(stage), random_(random) {}

  /// Puts the target on a surface within reach.
  bool placeTarget() {
    for (std::size_t n = 0; n < kObjectTries; ++n) {
      const std::uint32_t object = drawObject();
      const ObjectModel& model = stage_.objects.objects()[object];
      stable_ = &drawStablePose(model, random_);
      auto draw = drawPlace(model, object, *stable_);
      if (!draw || !isReached(*draw)) continue;
      target_ = draw->object;
      return true;
    }
    return false;
  }

  /// Draws another place for the target, in the same stable pose.
  bool placeGoal() {
    for (std::size_t n = 0; n < kObjectTries; ++n) {
      auto draw = drawPlace(*target_.model, target_.object, *stable_);
      if (!draw) continue;
      const Vec3 way = draw->object.pose.translation - target_.pose.translation;
      if (std::sqrt(dot(way, way)) < stage_.options.least_distance) continue;
      if (gapBetween(draw->object.footprint, target_.footprint) < kObjectGap) continue;
      if (!isReached(*draw)) continue;
      goal_ = draw->object;
      return true;
    }
    return false;
  }

  /// Places the other objects clear of each other, of target and goal, and of the positions in
  /// which the robot reaches these.
  bool placeOthers() {
    while (others_.size() + 1 < stage_.options.objects) {
      if (!placeOther()) return false;
    }
    return true;
  }

  /// Puts the robot on the floor, clear of all objects.
  bool placeRobot() {
    const std::vector<FloorPlace>& places = stage_.floor.places();
    for (std::size_t n = 0; n < kStartTries; ++n) {
      const FloorPlace& place = places[random_.below(static_cast<std::uint32_t>(places.size()))];
      const std::uint32_t heading = random_.below(kHeadings);
      base_yaw_ = yawOf(heading) + aside() * kTurn / static_cast<float>(kHeadings);
      base_position_ = stage_.floor.position(place);
      base_position_.x += aside() * stage_.floor.spacing();
      base_position_.z += aside() * stage_.floor.spacing();
      if (((place.headings >> heading) & 1U) == 0) continue;
      const auto height = stage_.floor.heightAt(base_position_.x, base_position_.z, place.height);
      if (!height) continue;
      base_position_.y = *height;
      const RobotBody body = robotBody(stage_.robot, groundPose(base_position_, base_yaw_),
                                       stage_.robot.startPositions());
      if (isFree(stage_.scene, body.spheres) && isClearOfObjects(body.spheres)) return true;
    }
    return false;
  }

  /// The episode, the target at a random index.
  [[nodiscard]] DraftedEpisode finish() {
    const auto count = static_cast<std::uint32_t>(others_.size() + 1);
    DraftedEpisode episode{.objects = others_,
                           .target = random_.below(count),
                           .goal = goal_,
                           .base_position = base_position_,
                           .base_yaw = base_yaw_};
    episode.objects.insert(episode.objects.begin() + episode.target, target_);
    return episode;
  }

 private:
  /// Somewhere in a cell: a share of its size between -1/2 and 1/2.
  float aside() { return static_cast<float>(random_.unit()) - 0.5F; }

  std::uint32_t drawObject() {
    return random_.below(static_cast<std::uint32_t>(stage_.objects.objects().size()));
  }

  /// A spot on a random place, turned at random, if the object stands there flat and free.
  std::optional<Draw> drawPlace(const ObjectModel& model, std::uint32_t object,
                                const StablePose& stable) {
    const auto& places = stage_.supports.places();
    const SupportPlace& place = places[random_.below(static_cast<std::uint32_t>(places.size()))];
    const float spacing = stage_.scene.grids().front().spacing();
    Spot spot{.x = place.x + spacing * aside(),
              .z = place.z + spacing * aside(),
              .surface = place.surface,
              .yaw = kTurn * static_cast<float>(random_.unit())};
    const PlacedObject roughly = placeObject(model, object, stable, spot);
    const auto surface = stage_.supports.surfaceUnder(roughly.footprint, place.surface);
    if (!surface) return std::nullopt;
    spot.surface = *surface;
    return Draw{placeObject(model, object, stable, spot), place.floor};
  }

  /// Remembers the position of the robot that reaches the object.
  bool isReached(const Draw& draw) {
    auto spheres = findReach(stage_, draw.object, draw.floor, random_);
    if (!spheres) return false;
    reaching_.push_back(std::move(*spheres));
    return true;
  }

  bool placeOther() {
    for (std::size_t n = 0; n < kObjectTries; ++n) {
      const std::uint32_t object = drawObject();
      const ObjectModel& model = stage_.objects.objects()[object];
      const auto draw = drawPlace(model, object, drawStablePose(model, random_));
      if (!draw || !isApart(draw->object)) continue;
      others_.push_back(draw->object);
      return true;
    }
    return false;
  }

  [[nodiscard]] bool isApart(const PlacedObject& object) const {
    const auto apart = [&](const PlacedObject& other) {
      return gapBetween(object.footprint, other.footprint) >= kObjectGap;
    };
    if (!apart(target_) || !apart(goal_)) return false;
    if (!std::all_of(others_.begin(), others_.end(), apart)) return false;
    return std::none_of(reaching_.begin(), reaching_.end(),
                        [&](const BodySpheres& spheres) { return touches(object, spheres); });
  }

  [[nodiscard]] bool isClearOfObjects(const BodySpheres& spheres) const {
    const auto clear = [&](const PlacedObject& object) { return !touches(object, spheres); };
    return clear(target_) && std::all_of(others_.begin(), others_.end(), clear);
  }

  const Stage& stage_;
  Random& random_;
  const StablePose* stable_ = nullptr;
  PlacedObject target_;
  PlacedObject goal_;
  std::vector<PlacedObject> others_;
  /// The robot where it reaches target and goal.
  std::vector<BodySpheres> reaching_;
  Vec3 base_position_;
  float base_yaw_ = 0;
};

}  // namespace

std::optional<DraftedEpisode> draftEpisode(const Stage& stage, Random random,
                                           DraftFailures& failures) {
  for (std::size_t n = 0; n < kDrafts; ++n) {
    Draft draft(stage, random);
    if (!draft.placeTarget()) {
      ++failures.target;
    } else if (!draft.placeGoal()) {
      ++failures.goal;
    } else if (!draft.placeOthers()) {
      ++failures.others;
    } else if (!draft.placeRobot()) {
      ++failures.start;
    } else {
      return draft.finish();
    }
  }
  return std::nullopt;
}

}  // namespace galactic::bake
