#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "galactic/bake/robot_import.h"
#include "support/scratch_folder.h"

namespace galactic::test {

inline std::string robotText(std::string_view content) {
  return fmt::format("<robot name=\"r\">{}</robot>", content);
}

/// A joint of any type, with more elements inside.
inline std::string jointText(std::string_view name, std::string_view type, std::string_view links,
                             std::string_view inside = "") {
  const std::size_t comma = links.find(',');
  return fmt::format(
      "<joint name=\"{}\" type=\"{}\"><parent link=\"{}\"/><child link=\"{}\"/>{}</joint>", name,
      type, links.substr(0, comma), links.substr(comma + 1), inside);
}

/// A link with one collision element.
inline std::string linkText(std::string_view name, std::string_view geometry) {
  return fmt::format("<link name=\"{}\"><collision><geometry>{}</geometry></collision></link>",
                     name, geometry);
}

inline Result<bake::SourceRobot> importText(const ScratchFolder& folder, const std::string& text,
                                            const bake::RobotImportOptions& options = {}) {
  return bake::importRobot(folder.write("robots/r.urdf", text), options);
}

/// The error's place without the scratch folder.
inline std::string placeIn(const ScratchFolder& folder, const Error& error) {
  const std::string prefix = (folder.path() / "robots/").string();
  return error.where.starts_with(prefix) ? error.where.substr(prefix.size()) : error.where;
}

/// The link of that name; a test that asks for another fails.
inline const bake::SourceLink& linkOf(const bake::SourceRobot& robot, std::string_view name) {
  for (const bake::SourceLink& link : robot.links) {
    if (link.name == name) return link;
  }
  ADD_FAILURE() << "no link " << name;
  return robot.links.front();
}

}  // namespace galactic::test
