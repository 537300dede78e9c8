#pragma once
#include <fmt/format.h>

#include <string>
#include <string_view>

#include "bake/robot_description/robot_texts.h"
#include "galactic/bake/robot_import.h"
#include "support/scratch_folder.h"

namespace galactic::test {

/// An MJCF whose <worldbody> has this in it, with other sections before it.
inline std::string mjcfText(std::string_view world, std::string_view sections = "") {
  return fmt::format("<mujoco model=\"m\">{}<worldbody>{}</worldbody></mujoco>", sections, world);
}

inline Result<bake::SourceRobot> importMjcf(const ScratchFolder& folder, const std::string& text,
                                            const bake::RobotImportOptions& options = {}) {
  return bake::importRobot(folder.write("robots/r.xml", text), options);
}

/// The robot, or a failure and an empty one.
inline bake::SourceRobot mjcfRobot(const ScratchFolder& folder, const std::string& text,
                                   const bake::RobotImportOptions& options = {}) {
  auto robot = importMjcf(folder, text, options);
  EXPECT_TRUE(robot.has_value()) << robot.error().text();
  return robot ? std::move(*robot) : bake::SourceRobot{};
}

/// The masses that the text states, or a failure and none.
inline std::vector<bake::LinkInertial> mjcfMasses(const ScratchFolder& folder,
                                                  const std::string& text) {
  const auto masses = bake::readInertials(folder.write("robots/r.xml", text));
  EXPECT_TRUE(masses.has_value()) << masses.error().text();
  return masses.value_or(std::vector<bake::LinkInertial>{});
}

}  // namespace galactic::test
