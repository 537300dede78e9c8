#include "episodes/home/robot_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "episodes/home/robot_body.h"

namespace galactic::bake {
namespace {

constexpr std::size_t kStartTries = 300;
/// Limit for all draws, including those that only the distance rules out.
constexpr std::size_t kDistanceTries = 10000;

/// A random offset within a cell, as a share of its size between -1/2 and 1/2.
float aside(Random& random) { return static_cast<float>(random.unit()) - 0.5F; }

/// Whether the robot in its start pose, with the base on the floor at about height `floor`, is
/// clear of everything; corrects the base's height.
bool standsFree(const StartHome& home, float floor, std::span<const PlacedObject> objects,
                RobotStart& start) {
  Vec3& base = start.base_position;
  const auto height = home.floor.heightAt(base.x, base.z, floor);
  if (!height) return false;
  base.y = *height;
  const RobotBody body =
      robotBody(home.robot, groundPose(base, start.base_yaw), home.robot.startPositions());
  return isFree(home.scene, body.spheres) &&
         std::ranges::none_of(
             objects, [&](const PlacedObject& object) { return touches(object, body.spheres); });
}

}  // namespace

std::optional<RobotStart> drawStart(const StartHome& home, const StartWish& wish, Random& random,
                                    RejectionCounts& rejections) {
  constexpr float kHeadingStep = 2 * std::numbers::pi_v<float> / static_cast<float>(kHeadings);
  const std::vector<FloorPlace>& places = home.floor.places();
  std::size_t tries = 0;
  for (std::size_t n = 0; n < kDistanceTries && tries < kStartTries && !places.empty(); ++n) {
    const FloorPlace& place = places[random.below(static_cast<std::uint32_t>(places.size()))];
    if (place.part != wish.part) {
      rejections.add(EpisodeRejection::kOtherPart);
      continue;
    }
    const std::uint32_t heading = random.below(kHeadings);
    RobotStart start;
    start.base_yaw = yawOf(heading) + aside(random) * kHeadingStep;
    start.base_position = home.floor.position(place);
    start.base_position.x += aside(random) * home.floor.spacing();
    start.base_position.z += aside(random) * home.floor.spacing();
    const Vec3 way = wish.target - start.base_position;
    const float distance = std::hypot(way.x, way.z);
    if (distance < wish.start_to_target.least || distance > wish.start_to_target.most) {
      rejections.add(EpisodeRejection::kStartDistance);
      continue;
    }
    ++tries;
    const bool is_free = ((place.headings >> heading) & 1U) != 0 &&
                         standsFree(home, place.height, wish.objects, start);
    if (is_free) return start;
    rejections.add(EpisodeRejection::kStartBlocked);
  }
  return std::nullopt;
}

std::string whyNowhere(const FloorMap& floor, const Robot& robot) {
  return fmt::format(
      "the robot {} stands nowhere: {} places on the floor were tried in {} headings each, and "
      "in its start pose one of its {} spheres was blocked at each; give a larger scene or a "
      "smaller start pose",
      robot.name(), floor.tried(), kHeadings, robot.spheres().size());
}

}  // namespace galactic::bake
