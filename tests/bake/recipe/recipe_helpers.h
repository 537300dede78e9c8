#pragma once
#include <string>

#include "galactic/bake/robot_recipe.h"
#include "support/scratch_folder.h"
#include "support/text/nearest_name.h"

namespace galactic::test {

/// Every key that a recipe must have, in five lines.
inline constexpr const char* kLeastRecipe =
    "name = \"r\"\n"
    "[end_effector]\n"
    "link = \"hand\"\n"
    "[base]\n"
    "footprint_radius = 0.3\n";

inline Result<bake::RobotRecipe> readText(const ScratchFolder& folder, const std::string& text) {
  return bake::readRobotRecipe(folder.write("r.toml", text));
}

/// A robot base - shoulder (revolute, -1 to 2) - arm - wrist (continuous) - hand, with a finger
/// that mimics the wrist and a fixed camera.
inline bake::SourceRobot smallRobot() {
  bake::SourceRobot robot;
  robot.name = "small";
  const auto add = [&](const char* name, int parent, const char* joint, JointType type) {
    bake::SourceLink& link = robot.links.emplace_back();
    link.name = name;
    link.parent = parent;
    link.joint_name = joint;
    link.joint_type = type;
  };
  add("base", -1, "", JointType::kFixed);
  add("arm", 0, "shoulder", JointType::kRevolute);
  robot.links.back().limits = bake::JointLimits{-1, 2};
  add("hand", 1, "wrist", JointType::kContinuous);
  add("finger", 2, "grip", JointType::kContinuous);
  robot.links.back().mimic = bake::Mimic{.link = 2, .multiplier = 1, .offset = 0};
  add("camera", 0, "mount", JointType::kFixed);
  add("lock", 0, "locked", JointType::kPrismatic);
  robot.links.back().limits = bake::JointLimits{0, 0};
  return robot;
}

}  // namespace galactic::test
