#include "episodes/episode_draft.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "episodes/reach_witness.h"
#include "episodes/trial/placement_check.h"

namespace galactic::bake {
namespace {

constexpr std::size_t kObjectTries = 300;
/// Limit for all draws of a goal's place, including those that a cheap check of surface and
/// distance rejects.
constexpr std::size_t kDistanceTries = 10000;
/// For a survey: tries to find a goal for one target, and the number of pairs that suffices.
constexpr std::size_t kGoalTries = 100;
constexpr std::size_t kEnoughPairs = 32;
constexpr float kTurn = 2 * std::numbers::pi_v<float>;

using BodySpheres = std::vector<BodySphere>;

/// Cosine of the angle by which the up axis of an object leans.
float uprightness(const StablePose& pose) { return rotate(pose.rotation, {0, 1, 0}).y; }

/// The least uprightness of the poses that may be drawn.
float leastUprightness(const ObjectModel& model, PoseChoice choice) {
  // For an object that stands askew on its bottom: the cosine of 15 degrees.
  constexpr float kUpright = 0.966F;
  if (choice == PoseChoice::kDropped) return -std::numeric_limits<float>::infinity();
  float most = -1;
  for (const StablePose& pose : model.stable_poses) most = std::max(most, uprightness(pose));
  return std::min(most, kUpright);
}

/// Draws a stable pose among the permitted ones, each with the likelihood that drops end in it.
const StablePose& drawStablePose(const ObjectModel& model, PoseChoice choice, Random& random) {
  const float least = leastUprightness(model, choice);
  const auto likelihood = [least](const StablePose& pose) {
    return uprightness(pose) >= least ? pose.likelihood : 0.0F;
  };
  float total = 0;
  for (const StablePose& pose : model.stable_poses) total += likelihood(pose);
  float left = static_cast<float>(random.unit()) * total;
  for (const StablePose& pose : model.stable_poses) {
    left -= likelihood(pose);
    if (left < 0) return pose;
  }
  // Rounding left a rest of the total.
  return *std::ranges::max_element(model.stable_poses, {}, likelihood);
}

bool isWithin(float distance, const DistanceRange& range) {
  return distance >= range.least && distance <= range.most;
}

/// How far settling may move an object from the place that was drawn for it, meters; half the
/// diagonal of a cell comes on top of this.
constexpr float kAside = kSettlingWay;

/// An object to put, and its stable pose.
struct Wanted {
  std::uint32_t object = 0;
  const StablePose* stable = nullptr;
};

/// An object on a support surface.
struct Draw {
  PlacedObject object;
  SupportPlace place;
};

/// One draft of an episode, with what has been placed so far.
class Draft {
 public:
  Draft(const DraftHome& home, const DraftEase& ease, Random& random, RejectionCounts& rejections)
      : home_(home), ease_(ease), random_(random), rejections_(rejections) {}

  /// Puts the target on a surface within reach.
  bool placeTarget() {
    for (std::size_t n = 0; n < kObjectTries; ++n) {
      chooseTarget();
      if (tryTarget(drawPlace(&ProvenPair::target))) return true;
    }
    return false;
  }

  void chooseTarget() { wanted_ = drawObject(); }

  /// Puts the chosen target on this place, if it stands there and can be reached.
  bool tryTarget(const SupportPlace& place) {
    const auto draw = stand(wanted_, place);
    if (!draw || !isReached(*draw)) return false;
    target_ = draw->object;
    target_surface_ = draw->place.surface_id;
    target_part_ = draw->place.part;
    return true;
  }

  /// Draws another place for the target, in the same stable pose.
  bool placeGoal() {
    std::size_t tries = 0;
    for (std::size_t n = 0; n < kDistanceTries && tries < kObjectTries; ++n) {
      const SupportPlace& place = drawPlace(&ProvenPair::goal);
      if (const auto fault = goalFault(place)) {
        rejections_.add(*fault);
        continue;
      }
      ++tries;
      if (tryGoal(place)) return true;
    }
    return false;
  }

  /// Puts the goal on this place, if it suits the target.
  bool tryGoal(const SupportPlace& place) {
    const auto draw = stand(wanted_, place);
    if (!draw || !isGoal(draw->object) || !isReached(*draw)) return false;
    goal_ = draw->object;
    return true;
  }

  /// Places where the goal may be, judged by surface and distance alone.
  struct GoalPlaces {
    /// Indices into SupportPlaces::places().
    std::vector<std::uint32_t> found;
    /// Why the other places are not suitable: of their faults, the one that is checked last.
    EpisodeRejection fault = EpisodeRejection::kOtherPart;
  };
  [[nodiscard]] GoalPlaces goalPlaces() const {
    constexpr std::array kOrder{EpisodeRejection::kOtherPart, EpisodeRejection::kSameSupport,
                                EpisodeRejection::kDistance};
    GoalPlaces goals;
    const auto& places = home_.supports.places();
    for (std::uint32_t n = 0; n < places.size(); ++n) {
      const auto fault = goalFault(places[n]);
      if (!fault) {
        goals.found.push_back(n);
      } else if (std::ranges::find(kOrder, *fault) > std::ranges::find(kOrder, goals.fault)) {
        goals.fault = *fault;
      }
    }
    return goals;
  }

  /// Places the other objects clear of each other, of target and goal, and of the positions in
  /// which the robot reaches these.
  bool placeOthers() {
    const CountRange& objects = home_.options.objects;
    const std::uint32_t count = objects.least + random_.below(objects.most - objects.least + 1);
    others_.reserve(count - std::size_t{1});
    while (others_.size() + 1 < count) {
      if (!placeOther()) return ease_.may_lack_objects;
    }
    return true;
  }

  /// Puts the robot on the floor, clear of all objects.
  bool placeRobot() {
    std::vector<PlacedObject> objects = others_;
    objects.push_back(target_);
    const auto start = drawStart({home_.scene, home_.robot, home_.floor},
                                 {.part = target_part_,
                                  .target = target_.pose.translation,
                                  .start_to_target = home_.options.start_to_target,
                                  .objects = objects},
                                 random_, rejections_);
    if (!start) return false;
    start_ = *start;
    return true;
  }

  /// The episode, with the target at a random index.
  [[nodiscard]] DraftedEpisode finish() {
    const auto count = static_cast<std::uint32_t>(others_.size() + 1);
    DraftedEpisode episode{
        .objects = others_, .target = random_.below(count), .goal = goal_, .start = start_};
    episode.objects.insert(episode.objects.begin() + episode.target, target_);
    return episode;
  }

 private:
  /// A random offset within a cell, as a share of its size between -1/2 and 1/2.
  float aside() { return static_cast<float>(random_.unit()) - 0.5F; }

  [[nodiscard]] const ObjectModel& modelOf(const Wanted& wanted) const {
    return home_.objects[wanted.object];
  }

  /// Draws any place or, half of the time, one that is proven for this end of the way.
  const SupportPlace& drawPlace(std::uint32_t ProvenPair::*end) {
    if (ease_.proven.empty() || random_.below(2) == 0) return home_.supports.draw(random_);
    const std::uint32_t pair = random_.below(static_cast<std::uint32_t>(ease_.proven.size()));
    return home_.supports.places()[ease_.proven[pair].*end];
  }

  Wanted drawObject() {
    const std::uint32_t object = random_.below(static_cast<std::uint32_t>(home_.objects.size()));
    return {object, &drawStablePose(home_.objects[object], home_.options.poses, random_)};
  }

  bool reject(EpisodeRejection reason) {
    rejections_.add(reason);
    return false;
  }

  /// Puts the object somewhere on the place, turned at random; none if it does not stand or stay
  /// there.
  std::optional<Draw> stand(const Wanted& wanted, const SupportPlace& place) {
    const float spacing = home_.scene.grids().front().spacing();
    Spot spot{.x = place.x + spacing * aside(),
              .z = place.z + spacing * aside(),
              .surface = place.surface,
              .yaw = kTurn * static_cast<float>(random_.unit())};
    auto object = put(wanted, spot);
    if (!object) return std::nullopt;
    if (home_.settling != nullptr) {
      const auto settled = settledSpot(*object, *wanted.stable, spot);
      if (!settled) return std::nullopt;
      spot = *settled;
      object = put(wanted, spot);
      if (!object) return std::nullopt;
    }
    if (canBeReleased(home_.scene, modelOf(wanted), object->pose)) return Draw{*object, place};
    rejections_.add(EpisodeRejection::kPlacement);
    return std::nullopt;
  }

  /// The object at `spot`, whose height this corrects; none if the surface is not flat and free
  /// there.
  std::optional<PlacedObject> put(const Wanted& wanted, Spot& spot) {
    const ObjectModel& model = modelOf(wanted);
    const PlacedObject roughly = placeObject(model, wanted.object, *wanted.stable, spot);
    const auto surface = home_.supports.surfaceUnder(roughly.footprint, spot.surface);
    if (!surface) {
      rejections_.add(EpisodeRejection::kNoRoom);
      return std::nullopt;
    }
    spot.surface = *surface;
    const PlacedObject object = placeObject(model, wanted.object, *wanted.stable, spot);
    const Footprint& print = object.footprint;
    if (!home_.supports.isAllowed({print.x, spot.surface, print.z})) {
      rejections_.add(EpisodeRejection::kOutsideReceptacle);
      return std::nullopt;
    }
    if (!isEven(print, spot.surface)) {
      rejections_.add(EpisodeRejection::kUneven);
      return std::nullopt;
    }
    return object;
  }

  /// Whether rays find no gap and no bump under the object; true if there are no rays.
  [[nodiscard]] bool isEven(const Footprint& print, float surface) const {
    return home_.rays == nullptr || home_.rays->isEven(print, surface, home_.options.flatness);
  }

  /// The spot where the object comes to rest after it is let go, moved and turned a little.
  std::optional<Spot> settledSpot(const PlacedObject& object, const StablePose& stable,
                                  const Spot& spot) {
    const Settled settled = home_.settling->settle(home_.bodies[object.object], object.pose);
    if (settled.end != SettlingEnd::kRests) {
      rejections_.add(settled.end == SettlingEnd::kTipped ? EpisodeRejection::kTipped
                                                          : EpisodeRejection::kMoved);
      return std::nullopt;
    }
    // The object's rotation about the vertical; it leans too little for this to be visible.
    const Quat turn = settled.pose.rotation * conjugate(stable.rotation);
    return Spot{.x = settled.pose.translation.x,
                .z = settled.pose.translation.z,
                .surface = spot.surface,
                .yaw = 2 * std::atan2(turn.y, turn.w)};
  }

  /// Why the goal cannot be anywhere in the place's cell; none if it could be.
  [[nodiscard]] std::optional<EpisodeRejection> goalFault(const SupportPlace& place) const {
    if (place.part != target_part_) return EpisodeRejection::kOtherPart;
    if (home_.options.goal_on_other_support && place.surface_id == target_surface_) {
      return EpisodeRejection::kSameSupport;
    }
    const float off = kAside + home_.scene.grids().front().spacing();
    const Vec3 way =
        Vec3{place.x, place.surface + wanted_.stable->height, place.z} - target_.pose.translation;
    const float distance = std::sqrt(dot(way, way));
    const DistanceRange& range = home_.target_to_goal;
    if (isWithin(distance, {range.least - off, range.most + off})) return std::nullopt;
    return EpisodeRejection::kDistance;
  }

  bool isGoal(const PlacedObject& object) {
    const Vec3 way = object.pose.translation - target_.pose.translation;
    if (!isWithin(std::sqrt(dot(way, way)), home_.target_to_goal)) {
      return reject(EpisodeRejection::kDistance);
    }
    if (gapBetween(object.footprint, target_.footprint) >= kObjectGap) return true;
    return reject(EpisodeRejection::kOverlap);
  }

  /// Whether the robot reaches the object; if so, remembers the position in which it does.
  bool isReached(const Draw& draw) {
    auto spheres = findReach(home_, draw.object, draw.place, random_);
    if (!spheres) return reject(EpisodeRejection::kNotReached);
    reaching_.push_back(std::move(*spheres));
    return true;
  }

  bool placeOther() {
    for (std::size_t n = 0; n < kObjectTries; ++n) {
      const Wanted wanted = drawObject();
      const auto draw = stand(wanted, drawPlace(&ProvenPair::goal));
      if (!draw) continue;
      if (isApart(draw->object)) {
        others_.push_back(draw->object);
        return true;
      }
      rejections_.add(EpisodeRejection::kOverlap);
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

  const DraftHome& home_;
  const DraftEase& ease_;
  Random& random_;
  RejectionCounts& rejections_;
  /// The object and the stable pose of the target.
  Wanted wanted_;
  PlacedObject target_;
  std::uint32_t target_surface_ = 0;
  /// FloorPlace::part where the whole episode takes place.
  std::uint32_t target_part_ = 0;
  PlacedObject goal_;
  std::vector<PlacedObject> others_;
  /// Spheres of the robot in the positions in which it reaches target and goal.
  std::vector<BodySpheres> reaching_;
  RobotStart start_;
};

}  // namespace

PairSearch findProvenPairs(const DraftHome& home) {
  PairSearch search;
  const auto count = static_cast<std::uint32_t>(home.supports.places().size());
  // A stream that no episode uses.
  Random random(~home.options.seed);
  const DraftEase anywhere;
  std::size_t tries = 0;
  while (tries < kSurveyTries && search.pairs.size() < kEnoughPairs) {
    ++tries;
    Draft draft(home, anywhere, random, search.rejections);
    draft.chooseTarget();
    const std::uint32_t target = random.below(count);
    if (!draft.tryTarget(home.supports.places()[target])) continue;
    ++search.reached_targets;
    const auto& [goals, fault] = draft.goalPlaces();
    if (goals.empty()) search.rejections.add(fault);
    for (std::size_t n = 0; n < kGoalTries && !goals.empty(); ++n, ++tries) {
      const std::uint32_t goal = goals[random.below(static_cast<std::uint32_t>(goals.size()))];
      if (!draft.tryGoal(home.supports.places()[goal])) continue;
      search.pairs.push_back({target, goal});
      break;
    }
  }
  return search;
}

DraftEnd draftEpisode(const DraftHome& home, const DraftEase& ease, Random& random,
                      DraftedEpisode& episode, RejectionCounts& rejections) {
  Draft draft(home, ease, random, rejections);
  if (!draft.placeTarget()) return DraftEnd::kTarget;
  if (!draft.placeGoal()) return DraftEnd::kGoal;
  if (!draft.placeOthers()) return DraftEnd::kOthers;
  if (!draft.placeRobot()) return DraftEnd::kStart;
  episode = draft.finish();
  return DraftEnd::kDone;
}

}  // namespace galactic::bake
