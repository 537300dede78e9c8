#include "robot_description/mjcf/couplings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/text/nearest_name.h"

namespace galactic::bake {
namespace {

constexpr std::string_view kRestingKey = "home";

/// The number of values in a pose that belong to a joint of this type.
std::size_t numbersOf(MjcfJointType type) {
  if (type == MjcfJointType::kFree) return 7;
  return type == MjcfJointType::kBall ? 4 : 1;
}

class Couplings {
 public:
  Couplings(const MjcfDefaults& defaults, const MjcfWorld& world, RobotDescription& robot)
      : defaults_(defaults), world_(world), robot_(robot) {
    for (const MjcfBody& body : world.bodies) {
      for (const MjcfJoint& joint : body.joints) stated_.emplace(joint.name, &joint);
    }
    for (DescribedJoint& joint : robot.joints) made_.emplace(joint.name, &joint);
  }

  void readEquality(const XmlElement& element) {
    const MjcfAttributes equality = defaults_.attributesOf(element, "");
    if (!equality.flag("active", true)) return;
    if (element.name == "connect" || element.name == "weld") ++loops_;
    if (element.name == "joint") couple(equality);
  }

  void warnOfLoops() {
    if (loops_ == 0) return;
    findings().warn(
        fmt::format("{} <connect> or <weld> of <equality> {} not read: loops of bodies "
                    "stay open, and what they would move stays where its joints are",
                    loops_, loops_ == 1 ? "is" : "are"));
  }

  void readKey(const XmlElement& element) {
    const MjcfAttributes key = defaults_.attributesOf(element, "");
    if (key.text("name") != kRestingKey || !key.has("qpos")) return;
    std::size_t wanted = 0;
    for (const MjcfBody& body : world_.bodies) {
      for (const MjcfJoint& joint : body.joints) wanted += numbersOf(joint.type);
    }
    const auto positions = key.numbers("qpos", wanted, wanted);
    if (!positions) return;
    std::size_t at = 0;
    for (const MjcfBody& body : world_.bodies) {
      for (const MjcfJoint& joint : body.joints) {
        if (const auto made = made_.find(joint.name); made != made_.end()) {
          made->second->has_rest = true;
          made->second->rest = (*positions)[at];
        }
        at += numbersOf(joint.type);
      }
    }
  }

  void readExclude(const XmlElement& element) {
    const MjcfAttributes exclude = defaults_.attributesOf(element, "");
    const DescribedPair pair{exclude.text("body1"), exclude.text("body2")};
    const bool are_links = isLink(pair.first) && isLink(pair.second) && pair.first != pair.second;
    if (are_links) robot_.touching.push_back(pair);
  }

 private:
  [[nodiscard]] MjcfFindings& findings() const { return defaults_.findings(); }

  [[nodiscard]] bool isLink(const std::string& name) const {
    return std::ranges::find(robot_.links, name, &DescribedLink::name) != robot_.links.end();
  }

  /// The joint that an attribute names, whether part of the robot or not. Reports an error and
  /// returns null if there is none.
  const MjcfJoint* jointOf(const MjcfAttributes& equality, std::string_view attribute) const {
    const std::string name = equality.text(attribute);
    const auto found = stated_.find(name);
    if (found != stated_.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [known, unused] : stated_) names.push_back(known);
    equality.error(attribute, "the name of a joint; " + suggestNames(name, names));
    return nullptr;
  }

  /// The joint at the end of the chain that `joint` follows; `joint` itself if it follows none.
  [[nodiscard]] DescribedJoint* leaderOf(DescribedJoint* joint) const {
    while (!joint->mimic.empty()) joint = made_.find(joint->mimic)->second;
    return joint;
  }

  void couple(const MjcfAttributes& equality) {
    const MjcfJoint* first = jointOf(equality, "joint1");
    if (first == nullptr) return;
    const auto numbers = equality.numbers("polycoef", 1, 5).value_or(std::vector<double>{0, 1});
    std::array<double, 5> polynomial{0, 1, 0, 0, 0};
    std::copy(numbers.begin(), numbers.end(), polynomial.begin());
    if (!equality.has("joint2")) {
      findings().warn(
          fmt::format("an <equality> holds joint '{}' at a position and is not read; "
                      "[limits] of a recipe can hold it",
                      first->name));
      return;
    }
    const MjcfJoint* second = jointOf(equality, "joint2");
    if (second == nullptr) return;
    const auto follower = made_.find(first->name);
    const auto leader = made_.find(second->name);
    // One of the joints is not part of the robot, or is held.
    if (follower == made_.end() || leader == made_.end()) return;
    if (polynomial[2] != 0 || polynomial[3] != 0 || polynomial[4] != 0) {
      findings().warn(
          fmt::format("an <equality> lets joint '{}' follow '{}' along a curve, which is "
                      "not read: '{}' moves by itself",
                      first->name, second->name, first->name));
      return;
    }
    // Positions count from the pose of the bodies in the text.
    const double multiplier = polynomial[1];
    const double offset = polynomial[0] + first->reference - multiplier * second->reference;
    follow(*follower->second, *leader->second, multiplier, offset);
  }

  /// Makes first = multiplier * second + offset hold, through whichever of the two is free to
  /// follow.
  void follow(DescribedJoint& first, DescribedJoint& second, double multiplier, double offset) {
    if (leaderOf(&first) == leaderOf(&second)) {
      findings().warn(
          fmt::format("an <equality> couples joints '{}' and '{}', which others couple "
                      "already; it is not read",
                      first.name, second.name));
    } else if (first.mimic.empty()) {
      first.mimic = second.name;
      first.multiplier = multiplier;
      first.offset = offset;
    } else if (second.mimic.empty() && multiplier != 0) {
      second.mimic = first.name;
      second.multiplier = 1 / multiplier;
      second.offset = -offset / multiplier;
    } else {
      findings().warn(
          fmt::format("an <equality> lets joint '{}' follow '{}', but it follows '{}' "
                      "already; it is not read",
                      first.name, second.name, first.mimic));
    }
  }

  const MjcfDefaults& defaults_;
  const MjcfWorld& world_;
  RobotDescription& robot_;
  std::map<std::string, const MjcfJoint*, std::less<>> stated_;
  std::map<std::string, DescribedJoint*, std::less<>> made_;
  std::size_t loops_ = 0;
};

}  // namespace

void addCouplings(const XmlElement& root, const MjcfDefaults& defaults, const MjcfWorld& world,
                  RobotDescription& robot) {
  Couplings couplings(defaults, world, robot);
  for (const XmlElement& section : root.children) {
    for (const XmlElement& element : section.children) {
      if (section.name == "equality") couplings.readEquality(element);
      if (section.name == "keyframe" && element.name == "key") couplings.readKey(element);
      if (section.name == "contact" && element.name == "exclude") couplings.readExclude(element);
    }
  }
  couplings.warnOfLoops();
}

}  // namespace galactic::bake
