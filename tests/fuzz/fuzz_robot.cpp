// Any bytes as the text of a URDF or an MJCF, with no mesh at hand. The import has to give an error
// or a sound robot: a tree whose numbers are finite. A crash of the XML parser is an error like
// others.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "finding.h"
#include "galactic/bake/robot_import.h"
#include "support/scratch_folder.h"

namespace {

using galactic::JointType;
using galactic::bake::SourceLink;
using galactic::bake::SourceRobot;
using galactic::test::expectGoodError;
using galactic::test::reportFinding;

bool isFinite(const galactic::bake::Affine& affine) {
  return std::all_of(affine.begin(), affine.end(), [](double v) { return std::isfinite(v); });
}

void checkLink(const SourceRobot& robot, std::size_t index) {
  constexpr double kRounding = 1e-9;
  const SourceLink& link = robot.links[index];
  const bool is_root = index == 0;
  if ((link.parent < 0) != is_root || link.parent >= static_cast<int>(index)) {
    reportFinding("a parent that does not stand before its child");
  }
  if (!isFinite(link.parent_from_joint)) reportFinding("a joint frame that is not finite");
  const double length = std::hypot(link.axis[0], link.axis[1], link.axis[2]);
  if (std::abs(length - 1) > kRounding) reportFinding("an axis that is not of unit length");
  const bool limited =
      link.joint_type == JointType::kRevolute || link.joint_type == JointType::kPrismatic;
  if (link.limits.has_value() != limited) reportFinding("limits where none belong, or none");
  if (link.limits && !(link.limits->lower <= link.limits->upper))
    reportFinding("limits out of order");
  if (link.mimic &&
      (link.mimic->link >= robot.links.size() || robot.links[link.mimic->link].mimic.has_value())) {
    reportFinding("a mimic that leads nowhere");
  }
  for (const auto* shapes : {&link.collisions, &link.visuals}) {
    for (const auto& shape : *shapes) {
      if (!isFinite(shape.link_from_shape)) reportFinding("a shape whose frame is not finite");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const galactic::test::ScratchFolder folder;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto path = folder.write("robot.xml", text);
  galactic::bake::RobotImportOptions options;
  options.allow_missing = true;
  options.time_limit = std::chrono::seconds(5);
  const auto robot = galactic::bake::importRobot(path, options);
  if (!robot) {
    expectGoodError(robot.error());
    return 0;
  }
  if (robot->links.empty()) reportFinding("a robot without links");
  for (std::size_t i = 0; i < robot->links.size(); ++i) checkLink(*robot, i);
  return 0;
}
