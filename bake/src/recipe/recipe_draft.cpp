#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "galactic/bake/robot_recipe.h"
#include "recipe/robot_guess.h"
#include "support/text/printable.h"

namespace galactic::bake {
namespace {

/// Farthest moves of one action; the angle is that of the Galactic paper.
constexpr double kRevoluteStep = 0.196;
constexpr double kPrismaticStep = 0.05;
/// Example values for joints whose limits allow no movement, such as those of a hand that opens.
constexpr double kExampleTurn = 0.5;
constexpr double kExampleSlide = 0.05;

/// Meters, rounded to millimeters; never -0.
template <typename Real>
Real inMillimeters(Real meters) {
  return std::round(meters * 1000) / 1000 + Real(0);
}

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

/// Writes the guesses about a robot as its recipe.
class RecipeDraft {
 public:
  explicit RecipeDraft(const SourceRobot& robot) : robot_(robot), guess_(guessRobot(robot)) {}

  std::string text() {
    addHead();
    addSensors();
    addBase();
    addJoints();
    addMimics();
    addLimits();
    addStartPose();
    addSpheres();
    return std::move(text_);
  }

 private:
  /// Number of joints leading to the hand that one action on the joint above `leader` moves.
  [[nodiscard]] std::size_t movedBy(std::size_t leader) const {
    auto moved = 1 + static_cast<std::size_t>(std::ranges::count(guess_.followers, leader,
                                                                 &RobotGuess::Follower::leader));
    for (int at = static_cast<int>(guess_.end_effector); at >= 0;) {
      const SourceLink& link = robot_.links[static_cast<std::size_t>(at)];
      if (link.mimic && link.mimic->link == leader) ++moved;
      at = link.parent;
    }
    return moved;
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
        "# A draft of a robot recipe: guessed from its file. Read what is marked 'guess', look at\n"
        "# the picture of the pack (galactic-pack picture), and correct it here. Every other key "
        "is\n"
        "# explained by `galactic-bake --print-recipe` without a robot.\n\nname = {}\n\n",
        tomlText(robot_.name.empty() ? "robot" : robot_.name));
    text_ +=
        "# What grasps: a sphere at a point of a link. Guess, by the links' names and the tree.\n";
    if (guess_.grasping.size() > 1) {
      text_ += fmt::format("# Links that may be meant: {}\n", namesOf(guess_.grasping));
    }
    const Vec3& grasp = guess_.grasp_point;
    text_ += fmt::format(
        "[end_effector]\nlink = {}\n"
        "# In the link's frame: between the fingers, but outside of the robot's spheres, where\n"
        "# nothing can be grasped. Guess: the link's origin, or a little in front of its body.\n"
        "grasp_point = [{:.3f}, {:.3f}, {:.3f}]\n"
        "grasp_radius = {:.3f}\n\n",
        tomlText(robot_.links[guess_.end_effector].name), inMillimeters(grasp.x),
        inMillimeters(-grasp.z), inMillimeters(grasp.y), RobotGuess::kGraspRadius);
  }

  void addSensors() {
    const std::vector<std::size_t>& cameras = guess_.cameras;
    if (cameras.empty()) {
      text_ += "# No link is named like a camera. Name the one that carries it, or it has none.\n";
      text_ += fmt::format("# [camera]\n# link = {}\n# rpy_degrees = [0, 20, 0]\n",
                           tomlText(robot_.links.front().name));
      text_ += "# vertical_fov_degrees = 60\n\n";
    } else {
      text_ += fmt::format("# Guess, by what the file calls a camera, or by the links' names: {}\n",
                           namesOf(cameras));
      addCamera();
    }
    if (guess_.lasers.empty()) return;
    text_ += fmt::format(
        "# A laser scanner, perhaps. No joint that moves may carry it.\n"
        "# [laser]\n# link = {}\n# fov_degrees = 220\n# range = 25.0\n\n",
        tomlText(robot_.links[guess_.lasers.front()].name));
  }

  void addCamera() {
    const std::string& name = robot_.links[guess_.cameras.front()].name;
    const bool is_optical = guess_.camera_is_optical;
    const int roll = guess_.camera_roll_degrees;
    if (roll != 0) {
      text_ += fmt::format(
          "# At the start pose its image would {} ([{}, 0] is the link's own): it is turned\n"
          "# by {} degrees about its view, so that up in the image is up in the world.\n",
          roll == 180 ? "be upside down" : "lie on its side", is_optical ? "90, -90" : "0, 0",
          std::abs(roll));
    }
    const int whole_roll = (is_optical ? 90 : 0) + roll;
    text_ += fmt::format(
        "[camera]\nlink = {}\nrpy_degrees = [{}, {}, 0]   # {}\nvertical_fov_degrees = 60\n\n",
        tomlText(name), whole_roll > 180 ? whole_roll - 360 : whole_roll, is_optical ? -90 : 0,
        is_optical ? "of an optical frame: Z forward, Y down" : "it looks along X of the link");
  }

  void addBase() {
    text_ += fmt::format(
        "# The base: the root link, '{}', which drives and turns on the ground. Guess: what is "
        "near\n"
        "# the ground, but for the arm, stands for the footprint, and its lowest point touches the "
        "ground.\n"
        "[base]\nfootprint_radius = {:.3f}\nroot_height = {:.3f}\n"
        "forward_step = 0.1\nturn_step_degrees = 5.0\n"
        "# sideways_step = 0.1   # if it drives sideways, too: one action more\n\n",
        printable(robot_.links.front().name), guess_.footprint_radius,
        inMillimeters(guess_.root_height));
  }

  void addJoints() {
    const std::string hand = printable(robot_.links[guess_.end_effector].name);
    if (guess_.joints.empty()) {
      text_ += "# No joint that moves leads to the end effector: only the base acts.\n\n";
    } else {
      text_ += fmt::format(
          "# What actions move: the joints that lead to '{}'. The order is that of the actions.\n",
          hand);
    }
    for (const std::size_t n : guess_.joints) {
      text_ += jointEntry(n, "");
      if (const auto& limits = robot_.links[n].limits) text_ += rangeOf(*limits);
      text_ += "\n\n";
    }
    for (const std::size_t n : guess_.unlimited) {
      text_ += fmt::format(
          "# '{}' leads to '{}', too, but its limits of {:.4g} to {:.4g} stand for none: no\n"
          "# action moves it. If one should, give it limits in [limits] and put it here:\n{}\n\n",
          printable(robot_.links[n].joint_name), hand, robot_.links[n].limits->lower,
          robot_.links[n].limits->upper, jointEntry(n, "# "));
    }
  }

  /// The entry of a joint that actions move; each of its lines begins with `margin`.
  [[nodiscard]] std::string jointEntry(std::size_t n, std::string_view margin) const {
    const SourceLink& link = robot_.links[n];
    const bool slides = link.joint_type == JointType::kPrismatic;
    double step = slides ? kPrismaticStep / static_cast<double>(movedBy(n)) : kRevoluteStep;
    if (link.limits) step = std::min(step, (link.limits->upper - link.limits->lower) / 4);
    return fmt::format("{0}[[joints]]\n{0}name = {1}\n{0}step = {2:.3g}", margin,
                       tomlText(link.joint_name), std::max(step, 1e-4));
  }

  static std::string rangeOf(const JointLimits& limits) {
    return fmt::format("   # from {:.4g} to {:.4g}", limits.lower, limits.upper);
  }

  void addMimics() {
    if (guess_.followers.empty()) return;
    text_ +=
        "# Guess: equal sliding joints in series are the stages of a telescope, and follow\n"
        "# the first of them. One action moves all of them, the hand by as many steps. Without "
        "its\n"
        "# line here, and with one in [[joints]], a joint moves by itself.\n[mimic]\n";
    for (const RobotGuess::Follower& follower : guess_.followers) {
      text_ +=
          fmt::format("{} = {{ joint = {} }}\n", tomlText(robot_.links[follower.link].joint_name),
                      tomlText(robot_.links[follower.leader].joint_name));
    }
    text_ += "\n";
  }

  void addLimits() {
    const auto assumed = [](const SourceLink& link) {
      return link.limits_are_assumed && !link.mimic;
    };
    const bool any_assumed = std::ranges::any_of(robot_.links, assumed);
    if (!any_assumed && guess_.locked.empty()) return;
    text_ += "[limits]\n";
    if (any_assumed) {
      text_ += "# The robot's file states no limits for these: guesses, radians or meters.\n";
    }
    for (const SourceLink& link : robot_.links) {
      if (!assumed(link)) continue;
      text_ += fmt::format("{} = [{}, {}]\n", tomlText(link.joint_name), link.limits->lower,
                           link.limits->upper);
    }
    if (!guess_.locked.empty()) {
      text_ +=
          "# Both limits of these are the same in the robot's file: they cannot move. If they "
          "can, "
          "as\n# fingers may, give them limits, radians or meters, and a place in [start_pose]. "
          "Examples:\n";
    }
    for (const std::size_t n : guess_.locked) {
      const SourceLink& link = robot_.links[n];
      text_ += fmt::format("# {} = [{}, {:.4g}]\n", tomlText(link.joint_name), link.limits->lower,
                           link.limits->lower + exampleRange(link));
    }
    text_ += "\n";
  }

  static double exampleRange(const SourceLink& link) {
    return link.joint_type == JointType::kPrismatic ? kExampleSlide : kExampleTurn;
  }

  void addStarts(const std::vector<std::size_t>& links) {
    for (const std::size_t n : links) {
      const SourceLink& link = robot_.links[n];
      const double rest = link.rest.value_or(0);
      const double start =
          link.limits ? std::clamp(rest, link.limits->lower, link.limits->upper) : rest;
      text_ += fmt::format("{} = {}", tomlText(link.joint_name), start);
      if (link.limits) text_ += rangeOf(*link.limits);
      text_ += '\n';
    }
  }

  void addLockedStarts() {
    for (const std::size_t n : guess_.locked) {
      const SourceLink& link = robot_.links[n];
      text_ += fmt::format("# {} = {:.4g}   # with limits in [limits]\n", tomlText(link.joint_name),
                           link.limits->lower + exampleRange(link) / 2);
    }
  }

  void addStartPose() {
    if (guess_.joints.empty() && guess_.resting.empty() && guess_.locked.empty()) return;
    text_ +=
        "# Where joints start, controlled or not: folded, and away from the limits, is best.\n";
    text_ += "[start_pose]\n";
    addStarts(guess_.joints);
    if (!guess_.resting.empty() || !guess_.locked.empty()) {
      text_ += "# No action moves these: fold other arms and open the hand here.\n";
    }
    addStarts(guess_.resting);
    addLockedStarts();
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
  const RobotGuess guess_;
  std::string text_;
};

}  // namespace

std::string draftRobotRecipe(const SourceRobot& robot) { return RecipeDraft(robot).text(); }

}  // namespace galactic::bake
