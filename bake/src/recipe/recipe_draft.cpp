#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "common/lower_case.h"
#include "galactic/bake/robot_recipe.h"
#include "galactic/bake/triangle_mesh.h"
#include "robot/robot_parts.h"
#include "support/printable.h"

namespace galactic::bake {
namespace {

/// Parts of names by which people tell what grasps and what sees, the surest first.
constexpr std::array<std::string_view, 9> kGraspingNames{
    "grasp", "tcp", "tool", "end_effector", "eef", "ee_", "gripper", "hand", "palm"};
/// What closes around an object, and is not the hand that carries it.
constexpr std::array<std::string_view, 4> kFingerNames{"finger", "fngr", "knuckle", "jaw"};
constexpr std::array<std::string_view, 4> kCameraNames{"color_optical", "rgb_optical", "optical",
                                                       "camera"};
constexpr std::array<std::string_view, 3> kLaserNames{"laser", "lidar", "scan"};
/// Farthest moves of one action: the angle is the Galactic paper's.
constexpr double kRevoluteStep = 0.196;
constexpr double kPrismaticStep = 0.05;
constexpr float kGraspRadius = 0.015F;
/// How far the spheres stick out of a robot: the tau of a bake, meters.
constexpr float kSphereMargin = 0.04F;
/// Parts of the robot lower than this, above its lowest point, cover the ground. Meters.
constexpr float kBaseHeight = 0.25F;

/// A TOML string.
std::string tomlText(std::string_view name) {
  std::string text = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\') {
      text += '\\';
      text += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      text += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    } else {
      text += c;
    }
  }
  return text + '"';
}

/// Rounded to whole millimeters, and never -0.
float inMillimeters(float meters) { return std::round(meters * 1000) / 1000 + 0.0F; }

/// Guesses what a robot's recipe says, and writes it down.
class RecipeDraft {
 public:
  explicit RecipeDraft(const SourceRobot& robot)
      : robot_(robot), flat_(flattenKinematics(robot, nullptr)) {}

  std::string text() {
    chooseEndEffector();
    addHead();
    addSensors();
    addBase();
    addJoints();
    addLimits();
    addStartPose();
    addSpheres();
    return std::move(text_);
  }

 private:
  /// Links whose names have one of the parts, those with the surest part first.
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

  /// Whether a link is a finger, or hangs from one.
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

  /// Whether `carrier` is a link or one above it.
  [[nodiscard]] bool carries(std::size_t carrier, std::size_t link) const {
    auto at = static_cast<int>(link);
    while (at > static_cast<int>(carrier)) at = robot_.links[static_cast<std::size_t>(at)].parent;
    return at == static_cast<int>(carrier);
  }

  /// Whether an action may move the joint above a link.
  [[nodiscard]] bool canMove(const SourceLink& link) const {
    const bool has_position = link.joint_type == JointType::kRevolute ||
                              link.joint_type == JointType::kContinuous ||
                              link.joint_type == JointType::kPrismatic;
    if (link.parent < 0 || !has_position || link.mimic) return false;
    return !link.limits || link.limits->lower < link.limits->upper;
  }

  /// The links below the joints that lead to a link and can move, the root's side first. Joints
  /// above everything that can be seen or touched are how other simulators drive the base.
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
    candidates_ = linksNamed(kGraspingNames);
    std::erase_if(candidates_, [&](std::size_t n) { return isFinger(n); });
    const auto moves = [&](std::size_t n) { return !movingChain(n).empty(); };
    std::stable_partition(candidates_.begin(), candidates_.end(), moves);
    if (!candidates_.empty() && moves(candidates_.front())) {
      end_effector_ = candidates_.front();
    } else {
      for (std::size_t n = 0; n < robot_.links.size(); ++n) {
        if (isFinger(n)) continue;
        if (movingChain(n).size() > movingChain(end_effector_).size()) end_effector_ = n;
      }
    }
    joints_ = movingChain(end_effector_);
  }

  [[nodiscard]] std::string namesOf(const std::vector<std::size_t>& links) const {
    constexpr std::size_t kMost = 6;
    std::string names;
    for (std::size_t n = 0; n < std::min(links.size(), kMost); ++n) {
      names += (n == 0 ? "" : ", ") + printable(robot_.links[links[n]].name);
    }
    return links.size() > kMost ? names + ", ..." : names;
  }

  void addHead() {
    text_ += fmt::format(
        "# A draft of a robot recipe: guessed from the URDF. Read what is marked 'guess', look at\n"
        "# the picture of the pack (galactic-pack picture), and correct it here. Every other key "
        "is\n"
        "# explained by `galactic-bake --print-recipe` without a URDF.\n\nname = {}\n\n",
        tomlText(robot_.name.empty() ? "robot" : robot_.name));
    text_ +=
        "# What grasps: a sphere at a point of a link. Guess, by the links' names and the tree.\n";
    if (candidates_.size() > 1) {
      text_ += fmt::format("# Links that may be meant: {}\n", namesOf(candidates_));
    }
    const Vec3 grasp = graspPoint();
    text_ += fmt::format(
        "[end_effector]\nlink = {}\n"
        "# In the link's frame: between the fingers, but outside of the robot's spheres, where\n"
        "# nothing can be grasped. Guess: the link's origin, or a little in front of its body.\n"
        "grasp_point = [{:.3f}, {:.3f}, {:.3f}]\n"
        "grasp_radius = {:.3f}\n\n",
        tomlText(robot_.links[end_effector_].name), inMillimeters(grasp.x), inMillimeters(-grasp.z),
        inMillimeters(grasp.y), kGraspRadius);
  }

  /// In front of everything that moves with the end effector, seen from where it is mounted; its
  /// origin, where that is in front of all, or nothing says where the front is.
  [[nodiscard]] Vec3 graspPoint() const {
    const std::vector<Pose> poses = startPoses();
    const Pose hand_from_root = inverse(poses[end_effector_]);
    const Vec3 forward = forwardOf(hand_from_root, poses);
    float front = std::numeric_limits<float>::lowest();
    for (std::size_t n = 0; n < robot_.links.size(); ++n) {
      if (bodyOf(n) != bodyOf(end_effector_)) continue;
      for (const Vec3& p : surfaceOf(n)) {
        front = std::max(front, dot(forward, hand_from_root * (poses[n] * p)));
      }
    }
    return forward * std::max(front + kSphereMargin + kGraspRadius, 0.0F);
  }

  /// From the nearest link above the end effector that is not at the same place, to it: a unit
  /// vector in the end effector's frame. Zero where there is none.
  [[nodiscard]] Vec3 forwardOf(const Pose& hand_from_root, const std::vector<Pose>& poses) const {
    constexpr float kSamePlace = 1e-3F;
    for (int at = robot_.links[end_effector_].parent; at >= 0;
         at = robot_.links[static_cast<std::size_t>(at)].parent) {
      const Vec3 back = hand_from_root * poses[static_cast<std::size_t>(at)].translation;
      const float length = std::sqrt(dot(back, back));
      if (length > kSamePlace) return back * (-1 / length);
    }
    return {};
  }

  /// The link nearest to the root of those that fixed joints join to a link.
  [[nodiscard]] std::size_t bodyOf(std::size_t link) const {
    while (robot_.links[link].parent >= 0 && robot_.links[link].joint_type == JointType::kFixed) {
      link = static_cast<std::size_t>(robot_.links[link].parent);
    }
    return link;
  }

  void addSensors() {
    std::vector<std::size_t> cameras = linksNamed(kCameraNames);
    // A camera in the hand sees little of the room.
    std::stable_partition(cameras.begin(), cameras.end(), [&](std::size_t n) {
      return joints_.empty() || !carries(joints_.back(), n);
    });
    if (cameras.empty()) {
      text_ += "# No link is named like a camera. Name the one that carries it, or it has none.\n";
      text_ += fmt::format("# [camera]\n# link = {}\n# rpy_degrees = [0, 20, 0]\n",
                           tomlText(robot_.links.front().name));
      text_ += "# vertical_fov_degrees = 60\n\n";
    } else {
      const std::string& name = robot_.links[cameras.front()].name;
      const bool is_optical = lowerCase(name).find("optical") != std::string::npos;
      text_ += fmt::format(
          "# Guess, by the links' names: {}\n[camera]\nlink = {}\n"
          "rpy_degrees = {}   # {}\nvertical_fov_degrees = 60\n\n",
          namesOf(cameras), tomlText(name), is_optical ? "[90, -90, 0]" : "[0, 0, 0]",
          is_optical ? "of an optical frame: Z forward, Y down" : "it looks along X of the link");
    }
    const std::vector<std::size_t> lasers = linksNamed(kLaserNames);
    if (lasers.empty()) return;
    text_ += fmt::format(
        "# A laser scanner, perhaps. No joint that moves may carry it.\n"
        "# [laser]\n# link = {}\n# fov_degrees = 220\n# range = 25.0\n\n",
        tomlText(robot_.links[lasers.front()].name));
  }

  /// root_from_link of each link at the start.
  [[nodiscard]] std::vector<Pose> startPoses() const {
    std::vector<Pose> poses(robot_.links.size());
    forwardKinematics(flat_.links, {}, flat_.start_positions, poses);
    return poses;
  }

  /// Every surface point of a link, in its frame.
  [[nodiscard]] std::vector<Vec3> surfaceOf(std::size_t n) const {
    const SourceLink& link = robot_.links[n];
    return surfaceOfShapes(robot_, link.collisions.empty() ? link.visuals : link.collisions)
        .positions;
  }

  /// Every surface point of what no action moves, or of the robot if that has none, at the start
  /// pose, in the root's frame.
  [[nodiscard]] std::vector<Vec3> basePoints() const {
    const std::vector<Pose> poses = startPoses();
    std::vector<Vec3> base;
    std::vector<Vec3> arm;
    for (std::size_t n = 0; n < robot_.links.size(); ++n) {
      const bool is_arm = !joints_.empty() && carries(joints_.front(), n);
      for (const Vec3& p : surfaceOf(n)) (is_arm ? arm : base).push_back(poses[n] * p);
    }
    return base.empty() ? arm : base;
  }

  void addBase() {
    const std::vector<Vec3> points = basePoints();
    float lowest = std::numeric_limits<float>::max();
    for (const Vec3& p : points) lowest = std::min(lowest, p.y);
    float radius = 0;
    for (const Vec3& p : points) {
      if (p.y <= lowest + kBaseHeight) radius = std::max(radius, std::hypot(p.x, p.z));
    }
    const double root_height =
        points.empty() ? 0 : std::clamp(-static_cast<double>(lowest), -2., 2.);
    const double footprint =
        points.empty() ? 0.3 : std::clamp(static_cast<double>(radius), 0.05, 2.0);
    text_ += fmt::format(
        "# The base: the root link, '{}', which drives and turns on the ground. Guess: what is "
        "near\n"
        "# the ground, but for the arm, stands for the footprint, and its lowest point touches the "
        "ground.\n"
        "[base]\nfootprint_radius = {:.3f}\nroot_height = {:.3f}\n"
        "forward_step = 0.1\nturn_step_degrees = 5.0\n\n",
        printable(robot_.links.front().name), footprint, root_height);
  }

  void addJoints() {
    if (joints_.empty()) {
      text_ += "# No joint that moves leads to the end effector: only the base acts.\n\n";
      return;
    }
    text_ += fmt::format(
        "# What actions move: the joints that lead to '{}'. The order is that of the actions.\n",
        printable(robot_.links[end_effector_].name));
    for (const std::size_t n : joints_) {
      const SourceLink& link = robot_.links[n];
      double step = link.joint_type == JointType::kPrismatic ? kPrismaticStep : kRevoluteStep;
      if (link.limits) step = std::min(step, (link.limits->upper - link.limits->lower) / 4);
      text_ += fmt::format("[[joints]]\nname = {}\nstep = {:.3g}", tomlText(link.joint_name),
                           std::max(step, 1e-4));
      if (link.limits) {
        text_ += fmt::format("   # from {:.4g} to {:.4g}", link.limits->lower, link.limits->upper);
      }
      text_ += "\n\n";
    }
  }

  void addLimits() {
    bool any = false;
    for (const SourceLink& link : robot_.links) {
      if (!link.limits_are_assumed || link.mimic) continue;
      if (!any) {
        text_ += "# The URDF states no limits for these: guesses, radians or meters.\n[limits]\n";
      }
      any = true;
      text_ += fmt::format("{} = [{}, {}]\n", tomlText(link.joint_name), link.limits->lower,
                           link.limits->upper);
    }
    if (any) text_ += "\n";
  }

  /// The links below joints that stay where they start: a head, another arm, fingers. Wheels look
  /// the same however they turn.
  [[nodiscard]] std::vector<std::size_t> restingJoints() const {
    std::vector<std::size_t> resting;
    for (std::size_t n = 0; n < robot_.links.size(); ++n) {
      const std::vector<std::size_t> chain = movingChain(n);
      const bool is_last = !chain.empty() && chain.back() == n;
      const bool is_controlled = std::find(joints_.begin(), joints_.end(), n) != joints_.end();
      const bool turns_freely = robot_.links[n].joint_type == JointType::kContinuous;
      if (is_last && !is_controlled && !turns_freely) resting.push_back(n);
    }
    return resting;
  }

  void addStarts(const std::vector<std::size_t>& links) {
    for (const std::size_t n : links) {
      const SourceLink& link = robot_.links[n];
      const double start =
          link.limits ? std::clamp(0.0, link.limits->lower, link.limits->upper) : 0;
      text_ += fmt::format("{} = {}", tomlText(link.joint_name), start);
      if (link.limits) {
        text_ += fmt::format("   # from {:.4g} to {:.4g}", link.limits->lower, link.limits->upper);
      }
      text_ += '\n';
    }
  }

  void addStartPose() {
    const std::vector<std::size_t> resting = restingJoints();
    if (joints_.empty() && resting.empty()) return;
    text_ +=
        "# Where joints start, controlled or not: folded, and away from the limits, is best.\n";
    text_ += "[start_pose]\n";
    addStarts(joints_);
    if (!resting.empty()) {
      text_ += "# No action moves these: fold other arms and open the hand here.\n";
    }
    addStarts(resting);
    text_ += "\n";
  }

  void addSpheres() {
    text_ +=
        "# The collision spheres. Without max_spheres as many as keep every gap under max_gap.\n"
        "[spheres]\n"
        "# eps = 0.020\n"
        "# tau = 0.040\n"
        "# max_gap = 0.050\n"
        "# max_spheres = 100\n"
        "# clip_height = 0.020\n";
  }

  const SourceRobot& robot_;
  FlatKinematics flat_;
  std::vector<std::size_t> candidates_;
  std::size_t end_effector_ = 0;
  /// Links below the joints that actions move.
  std::vector<std::size_t> joints_;
  std::string text_;
};

}  // namespace

std::string draftRobotRecipe(const SourceRobot& robot) { return RecipeDraft(robot).text(); }

}  // namespace galactic::bake
