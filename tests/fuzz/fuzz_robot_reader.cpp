// Any bytes as the text of a URDF, an MJCF or an SRDF, parsed in the fuzzer's own process, so that
// it sees how far an input gets: what is made of the parser's result is ours, and so is the order
// of links. Elsewhere the parser runs in a process of its own; texts that it must not see are
// refused before, here as there.
#include <cstdint>
#include <string>

#include "finding.h"
#include "robot_description/description_reader.h"
#include "robot_description/link_tree.h"
#include "robot_description/mimics.h"
#include "robot_description/urdf/urdf_reader.h"

// Links that form a circle keep each other; what the parser leaks ends with the process in which it
// runs.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() { return "leak:liburdfdom"; }

namespace {

using namespace galactic::bake;
using galactic::test::expectGoodError;
using galactic::test::reportFinding;

constexpr const char* kWhere = "robot.xml";

void checkOrder(const RobotDescription& model, const std::vector<TreeLink>& tree) {
  if (tree.size() != model.links.size()) reportFinding("links that are lost");
  for (std::size_t i = 0; i < tree.size(); ++i) {
    if (tree[i].link >= model.links.size()) reportFinding("a link that is not there");
    if ((tree[i].parent < 0) != (i == 0) || tree[i].parent >= static_cast<int>(i)) {
      reportFinding("a parent that does not stand before its child");
    }
  }
}

void readRobot(const std::string& text, DescriptionPart part) {
  auto model = parseDescription(text, kWhere, {.part = part});
  if (!model) return expectGoodError(model.error());
  const auto tree = orderTree(*model, kWhere);
  if (!tree) return expectGoodError(tree.error());
  checkOrder(*model, *tree);
  std::vector<std::string> warnings;
  if (const auto checked = checkJoints(*model, kWhere, warnings); !checked) {
    return expectGoodError(checked.error());
  }
  std::vector<JointMimic> stated;
  for (const DescribedJoint& joint : model->joints) {
    stated.push_back({joint.name, joint.type, joint.mimic, joint.multiplier, joint.offset});
  }
  const auto mimics = resolveMimics(stated, kWhere);
  if (!mimics) return expectGoodError(mimics.error());
  for (const auto& mimic : *mimics) {
    if (mimic && (*mimics)[mimic->link]) reportFinding("a mimic of a joint that mimics");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const auto fits = checkRobotText(text, kWhere); !fits) {
    expectGoodError(fits.error());
    return 0;
  }
  readRobot(text, DescriptionPart::kShapesAndJoints);
  readRobot(text, DescriptionPart::kMasses);
  const auto spheres = parseSrdf(text, kWhere);
  if (!spheres) expectGoodError(spheres.error());
  return 0;
}
