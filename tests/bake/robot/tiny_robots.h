#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "galactic/bake/robot_recipe.h"
#include "galactic/bake/source_robot.h"

namespace galactic::test {

inline constexpr bake::Affine kNoChange{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

inline bake::Affine shifted(double x, double y, double z) {
  return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z};
}

/// What a link's joint is, where it is not the default.
struct JointFields {
  JointType type = JointType::kFixed;
  bake::Affine parent_from_joint = kNoChange;
  std::array<double, 3> axis{0, 1, 0};
  std::optional<bake::JointLimits> limits = std::nullopt;
};

/// Collects links into a robot. A link's joint is named after it: "NAME_joint".
class RobotMaker {
 public:
  explicit RobotMaker(std::string name = "tiny") { robot_.name = std::move(name); }

  RobotMaker& link(const std::string& name, int parent = -1, const JointFields& joint = {}) {
    bake::SourceLink& link = robot_.links.emplace_back();
    link.name = name;
    link.parent = parent;
    link.parent_from_joint = parent < 0 ? kNoChange : joint.parent_from_joint;
    if (parent < 0) return *this;
    link.joint_name = name + "_joint";
    link.joint_type = joint.type;
    link.axis = joint.axis;
    link.limits = joint.limits;
    return *this;
  }

  /// The last link's joint follows that of `leader`.
  RobotMaker& mimic(std::uint32_t leader, double multiplier, double offset) {
    robot_.links.back().mimic = bake::Mimic{leader, multiplier, offset};
    return *this;
  }

  /// A collision box of the last link.
  RobotMaker& box(const std::array<double, 3>& size,
                  const bake::Affine& link_from_box = kNoChange) {
    robot_.links.back().collisions.push_back({bake::BoxShape{size}, link_from_box, std::nullopt});
    return *this;
  }

  [[nodiscard]] const bake::SourceRobot& robot() const { return robot_; }

 private:
  bake::SourceRobot robot_;
};

/// The least recipe for a link that grasps.
inline bake::RobotRecipe recipeFor(const std::string& hand) {
  bake::RobotRecipe recipe;
  recipe.name = "tiny";
  recipe.source = "tiny.toml";
  recipe.end_effector.link = {hand, "tiny.toml:2"};
  // Far from every sphere.
  recipe.end_effector.grasp_point = {0, 1, 0};
  recipe.base.footprint = bake::FootprintCircle{0.3};
  return recipe;
}

}  // namespace galactic::test
