#include "recipe/robot_guess.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>

#include "common/lower_case.h"
#include "galactic/bake/triangle_mesh.h"
#include "robot/robot_parts.h"

namespace galactic::bake {
namespace {

/// Parts of names that people give to links that grasp or see, the surest first.
constexpr std::array<std::string_view, 9> kGraspingNames{
    "grasp", "tcp", "tool", "end_effector", "eef", "ee_", "gripper", "hand", "palm"};
/// Parts of names of things that close around an object, unlike the hand that carries them.
constexpr std::array<std::string_view, 4> kFingerNames{"finger", "fngr", "knuckle", "jaw"};
constexpr std::array<std::string_view, 4> kCameraNames{"color_optical", "rgb_optical", "optical",
                                                       "camera"};
constexpr std::array<std::string_view, 3> kLaserNames{"laser", "lidar", "scan"};
/// Limits at least this far apart mean that there are none: radians or meters.
constexpr double kWidestLimits = 100;
/// How far the spheres protrude from a robot: the tau of a bake, meters.
constexpr float kSphereMargin = 0.04F;
/// Parts of the robot below this height above its lowest point count for the footprint. Meters.
constexpr float kBaseHeight = 0.25F;

class RobotGuesser {
 public:
  explicit RobotGuesser(const SourceRobot& robot)
      : robot_(robot), flat_(flattenKinematics(robot, nullptr)) {}

  RobotGuess guess() {
    chooseEndEffector();
    guess_.grasp_point = graspPoint();
    guess_.resting = restingJoints();
    guess_.locked = lockedJoints();
    chooseCamera();
    guess_.lasers = linksNamed(kLaserNames);
    measureBase();
    return std::move(guess_);
  }

 private:
  /// Links whose names contain one of `parts`; those with the surest part come first.
  [[nodiscard]] std::vector<std::size_t> linksNamed(std::span<const std::string_view> parts) const {
    std::vector<std::size_t> found;
    for (const std::string_view part : parts) {
      for (std::size_t n = 0; n < robot_.links.size(); ++n) {
        const bool fits = lowerCase(robot_.links[n].name).find(part) != std::string::npos;
        if (fits && std::find(found.begin(), found.end(), n) == found.end()) found.push_back(n);
      }
    }
    return found;
  }

  /// Whether a link is a finger, or is below one in the tree.
  [[nodiscard]] bool isFinger(std::size_t link) const {
    for (auto at = static_cast<int>(link); at >= 0;
         at = robot_.links[static_cast<std::size_t>(at)].parent) {
      const std::string name = lowerCase(robot_.links[static_cast<std::size_t>(at)].name);
      const auto names = [&](std::string_view part) {
        return name.find(part) != std::string::npos;
      };
      if (std::any_of(kFingerNames.begin(), kFingerNames.end(), names)) return true;
    }
    return false;
  }

  /// Whether `carrier` is `link` itself or above it in the tree.
  [[nodiscard]] bool carries(std::size_t carrier, std::size_t link) const {
    auto at = static_cast<int>(link);
    while (at > static_cast<int>(carrier)) at = robot_.links[static_cast<std::size_t>(at)].parent;
    return at == static_cast<int>(carrier);
  }

  /// Whether an action can move the joint above a link.
  [[nodiscard]] bool canMove(const SourceLink& link) const {
    const bool has_position = link.joint_type == JointType::kRevolute ||
                              link.joint_type == JointType::kContinuous ||
                              link.joint_type == JointType::kPrismatic;
    if (link.parent < 0 || !has_position || link.mimic) return false;
    return !link.limits || link.limits->lower < link.limits->upper;
  }

  /// The links below the movable joints that lead to a link, from the root on. Leaves out joints
  /// above everything that has a shape: with those, other simulators drive the base.
  [[nodiscard]] std::vector<std::size_t> movingChain(std::size_t link) const {
    std::vector<std::size_t> chain;
    for (auto at = static_cast<int>(link); at >= 0;
         at = robot_.links[static_cast<std::size_t>(at)].parent) {
      chain.push_back(static_cast<std::size_t>(at));
    }
    std::reverse(chain.begin(), chain.end());
    std::vector<std::size_t> moving;
    bool has_body = false;
    for (const std::size_t n : chain) {
      const SourceLink& at = robot_.links[n];
      if (has_body && canMove(at)) moving.push_back(n);
      has_body = has_body || !at.collisions.empty() || !at.visuals.empty();
    }
    return moving;
  }

  void chooseEndEffector() {
    guess_.grasping = linksNamed(kGraspingNames);
    std::erase_if(guess_.grasping, [&](std::size_t n) { return isFinger(n); });
    const auto moves = [&](std::size_t n) { return !movingChain(n).empty(); };
    std::stable_partition(guess_.grasping.begin(), guess_.grasping.end(), moves);
    if (!guess_.grasping.empty() && moves(guess_.grasping.front())) {
      guess_.end_effector = guess_.grasping.front();
    } else {
      for (std::size_t n = 0; n < robot_.links.size(); ++n) {
        if (isFinger(n)) continue;
        if (movingChain(n).size() <= movingChain(guess_.end_effector).size()) continue;
        guess_.end_effector = n;
      }
    }
    for (const std::size_t n : movingChain(guess_.end_effector)) addJoint(n);
  }

  /// Adds a joint that leads to the end effector: it is one for actions, unless it follows the
  /// joint before it or has limits that cannot be meant.
  void addJoint(std::size_t n) {
    const SourceLink& link = robot_.links[n];
    if (link.limits && link.limits->upper - link.limits->lower > kWidestLimits) {
      guess_.unlimited.push_back(n);
    } else if (!guess_.joints.empty() && areOneTelescope(guess_.joints.back(), n)) {
      guess_.followers.push_back({.link = n, .leader = guess_.joints.back()});
    } else {
      guess_.joints.push_back(n);
    }
  }

  /// Whether two joints in series slide in the same direction and equally far.
  [[nodiscard]] bool areOneTelescope(std::size_t first, std::size_t second) const {
    constexpr double kSameLimit = 1e-6;
    constexpr float kParallel = 0.999F;
    const SourceLink& a = robot_.links[first];
    const SourceLink& b = robot_.links[second];
    const bool both_slide =
        a.joint_type == JointType::kPrismatic && b.joint_type == JointType::kPrismatic;
    if (!both_slide || !a.limits || !b.limits || a.limits_are_assumed || b.limits_are_assumed) {
      return false;
    }
    const std::vector<Pose> poses = startPoses();
    const auto direction = [&](std::size_t n) {
      return rotate(poses[n].rotation, flat_.links[n].axis);
    };
    return std::abs(a.limits->lower - b.limits->lower) < kSameLimit &&
           std::abs(a.limits->upper - b.limits->upper) < kSameLimit &&
           dot(direction(first), direction(second)) > kParallel;
  }

  /// The links below joints that stay where they start: a head, another arm, fingers. Leaves out
  /// wheels, which look the same however they turn.
  [[nodiscard]] std::vector<std::size_t> restingJoints() const {
    std::vector<std::size_t> resting;
    for (std::size_t n = 0; n < robot_.links.size(); ++n) {
      const std::vector<std::size_t> chain = movingChain(n);
      const bool is_last = !chain.empty() && chain.back() == n;
      const bool is_controlled =
          std::find(guess_.joints.begin(), guess_.joints.end(), n) != guess_.joints.end() ||
          std::ranges::find(guess_.followers, n, &RobotGuess::Follower::link) !=
              guess_.followers.end();
      const bool turns_freely = robot_.links[n].joint_type == JointType::kContinuous;
      if (is_last && !is_controlled && !turns_freely) resting.push_back(n);
    }
    return resting;
  }

  /// The links below joints that the file calls revolute or prismatic, but whose limits are the
  /// same.
  [[nodiscard]] std::vector<std::size_t> lockedJoints() const {
    std::vector<std::size_t> locked;
    for (std::size_t n = 0; n < robot_.links.size(); ++n) {
      const SourceLink& link = robot_.links[n];
      if (link.limits && !link.mimic && link.limits->lower == link.limits->upper) {
        locked.push_back(n);
      }
    }
    return locked;
  }

  /// A point in front of everything that is rigidly attached to the end effector, seen from where
  /// it is mounted. Its origin, if that is in front of everything, or if it is unknown where the
  /// front is.
  [[nodiscard]] Vec3 graspPoint() const {
    const std::vector<Pose> poses = startPoses();
    const Pose hand_from_root = inverse(poses[guess_.end_effector]);
    const Vec3 forward = forwardOf(hand_from_root, poses);
    float front = std::numeric_limits<float>::lowest();
    for (std::size_t n = 0; n < robot_.links.size(); ++n) {
      if (bodyOf(n) != bodyOf(guess_.end_effector)) continue;
      for (const Vec3& p : surfaceOf(n)) {
        front = std::max(front, dot(forward, hand_from_root * (poses[n] * p)));
      }
    }
    return forward * std::max(front + kSphereMargin + RobotGuess::kGraspRadius, 0.0F);
  }

  /// The direction to the end effector from the nearest link above it that is at another place: a
  /// unit vector in the end effector's frame. Zero if there is no such link.
  [[nodiscard]] Vec3 forwardOf(const Pose& hand_from_root, const std::vector<Pose>& poses) const {
    constexpr float kSamePlace = 1e-3F;
    for (int at = robot_.links[guess_.end_effector].parent; at >= 0;
         at = robot_.links[static_cast<std::size_t>(at)].parent) {
      const Vec3 back = hand_from_root * poses[static_cast<std::size_t>(at)].translation;
      const float length = std::sqrt(dot(back, back));
      if (length > kSamePlace) return back * (-1 / length);
    }
    return {};
  }

  /// Of all links that fixed joints connect to a link, the one nearest to the root.
  [[nodiscard]] std::size_t bodyOf(std::size_t link) const {
    while (robot_.links[link].parent >= 0 && robot_.links[link].joint_type == JointType::kFixed) {
      link = static_cast<std::size_t>(robot_.links[link].parent);
    }
    return link;
  }

  void chooseCamera() {
    guess_.cameras = linksNamed(kCameraNames);
    // Links that the file itself calls cameras come before those with fitting names.
    const auto is_camera = [&](std::size_t n) { return robot_.links[n].is_camera; };
    std::erase_if(guess_.cameras, is_camera);
    std::vector<std::size_t> stated;
    for (std::size_t n = 0; n < robot_.links.size(); ++n) {
      if (is_camera(n)) stated.push_back(n);
    }
    guess_.cameras.insert(guess_.cameras.begin(), stated.begin(), stated.end());
    // A camera in the hand sees little of the room.
    std::stable_partition(guess_.cameras.begin(), guess_.cameras.end(), [&](std::size_t n) {
      return guess_.joints.empty() || !carries(guess_.joints.back(), n);
    });
    if (guess_.cameras.empty()) return;
    const std::size_t link = guess_.cameras.front();
    guess_.camera_is_optical =
        !is_camera(link) && lowerCase(robot_.links[link].name).find("optical") != std::string::npos;
    guess_.camera_roll_degrees = uprightRoll(link, guess_.camera_is_optical);
  }

  /// The roll about the view direction, a multiple of 90 degrees, that makes the image of a camera
  /// on a link upright at the start pose. 0 if the camera looks up or down.
  [[nodiscard]] int uprightRoll(std::size_t link, bool is_optical) const {
    constexpr float kLooksUpOrDown = 0.9F;
    /// Margin by which another roll must be better, so that slanted cameras stay as they are.
    constexpr float kClearlyBetter = 0.1F;
    const auto in_root = [&, pose = startPoses()[link]](const Vec3& v) {
      return rotate(pose.rotation, v);
    };
    // In the file's axes, forward is Z and up is -Y on optical frames; elsewhere forward is X and
    // up is Z.
    const Vec3 forward = in_root(is_optical ? Vec3{0, 1, 0} : Vec3{1, 0, 0});
    const Vec3 up = in_root(is_optical ? Vec3{0, 0, 1} : Vec3{0, 1, 0});
    const Vec3 left = cross(up, forward);
    if (std::abs(forward.y) > kLooksUpOrDown) return 0;
    int best = 0;
    float height = up.y + kClearlyBetter;
    for (const auto& [roll, up_after] :
         {std::pair{90, left * -1.0F}, {-90, left}, {180, up * -1.0F}}) {
      if (up_after.y <= height) continue;
      best = roll;
      height = up_after.y;
    }
    return best;
  }

  /// root_from_link of each link at the start pose.
  [[nodiscard]] std::vector<Pose> startPoses() const {
    std::vector<Pose> poses(robot_.links.size());
    forwardKinematics(flat_.links, {}, flat_.start_positions, poses);
    return poses;
  }

  /// All vertices of a link's surface, in its frame.
  [[nodiscard]] std::vector<Vec3> surfaceOf(std::size_t n) const {
    const SourceLink& link = robot_.links[n];
    return surfaceOfShapes(robot_, link.collisions.empty() ? link.visuals : link.collisions)
        .positions;
  }

  /// All vertices of the parts that no action moves, or of the whole robot if these have none, at
  /// the start pose, in the root's frame.
  [[nodiscard]] std::vector<Vec3> basePoints() const {
    const std::vector<Pose> poses = startPoses();
    std::vector<Vec3> base;
    std::vector<Vec3> arm;
    for (std::size_t n = 0; n < robot_.links.size(); ++n) {
      const bool is_arm = !guess_.joints.empty() && carries(guess_.joints.front(), n);
      for (const Vec3& p : surfaceOf(n)) (is_arm ? arm : base).push_back(poses[n] * p);
    }
    return base.empty() ? arm : base;
  }

  void measureBase() {
    const std::vector<Vec3> points = basePoints();
    float lowest = std::numeric_limits<float>::max();
    for (const Vec3& p : points) lowest = std::min(lowest, p.y);
    float radius = 0;
    for (const Vec3& p : points) {
      if (p.y <= lowest + kBaseHeight) radius = std::max(radius, std::hypot(p.x, p.z));
    }
    guess_.root_height = points.empty() ? 0 : std::clamp(-static_cast<double>(lowest), -2., 2.);
    guess_.footprint_radius =
        points.empty() ? 0.3 : std::clamp(static_cast<double>(radius), 0.05, 2.0);
  }

  const SourceRobot& robot_;
  FlatKinematics flat_;
  RobotGuess guess_;
};

}  // namespace

RobotGuess guessRobot(const SourceRobot& robot) { return RobotGuesser(robot).guess(); }

}  // namespace galactic::bake
