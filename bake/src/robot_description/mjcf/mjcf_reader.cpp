#include "robot_description/mjcf/mjcf_reader.h"

#include "robot_description/mjcf/assets.h"
#include "robot_description/mjcf/attributes.h"
#include "robot_description/mjcf/bodies.h"
#include "robot_description/mjcf/couplings.h"
#include "robot_description/mjcf/included_files.h"
#include "robot_description/mjcf/robot_links.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// MuJoCo's name for a model without a name.
constexpr const char* kUnnamed = "MuJoCo Model";

void readRobot(const XmlElement& root, const std::string& where, DescriptionPart part,
               MjcfFindings& findings, RobotDescription& robot) {
  MjcfDefaults defaults(findings);
  MjcfSettings settings;
  for (const XmlElement& section : root.children) {
    if (section.name == "default") defaults.add(section);
    if (section.name == "compiler") settings.read(defaults.attributesOf(section, ""));
  }
  const MjcfAssets assets(root, defaults, settings, findings, robot);
  const MjcfWorld world = readBodies(root, defaults, settings, assets, part);
  if (findings.firstError()) return;
  const RobotBodies chosen = chooseRobot(world, where, findings);
  if (findings.firstError()) return;
  addLinks(world, chosen, settings, part, findings, robot);
  addCouplings(root, defaults, world, robot);
  robot.total_mass = settings.total_mass.value_or(0);
}

}  // namespace

Result<RobotDescription> parseMjcf(const std::string& text, const std::filesystem::path& path,
                                   const DescriptionRequest& request) {
  ASSIGN_OR_RETURN(const auto whole, parseWithIncluded(text, path, request.allow_outside));
  RobotDescription robot;
  const std::string* model = whole.root.find("model");
  robot.name = model == nullptr ? kUnnamed : *model;
  for (const auto& file : whole.included) robot.included.push_back(file.string());
  for (const auto& file : whole.absent) robot.absent.push_back(file.string());
  MjcfFindings findings;
  readRobot(whole.root, path.string(), request.part, findings, robot);
  if (findings.firstError()) return tl::unexpected(*findings.firstError());
  robot.warnings = findings.warnings();
  return robot;
}

}  // namespace galactic::bake
