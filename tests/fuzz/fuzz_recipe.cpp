// Any bytes as a file in TOML: the first byte picks which (its value modulo 3), the others are its
// text: 0 the recipe of a world, 1 the recipe of a robot, 2 options for --config. What is read has
// to keep what the headers promise, and robots' recipes are held against a small robot.
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "bake/recipe/recipe_helpers.h"
#include "command.h"
#include "finding.h"
#include "galactic/bake/robot_recipe.h"
#include "recipe/world_recipe.h"
#include "support/scratch_folder.h"

namespace {

using namespace galactic;
using namespace galactic::bake;
using test::expectGoodError;
using test::reportFinding;

void readWorld(const std::filesystem::path& path) {
  const auto recipe = readWorldRecipe(path);
  if (!recipe) return expectGoodError(recipe.error());
  if (recipe->scenes.empty()) reportFinding("a world without scenes");
  for (const auto* assets : {&recipe->scenes, &recipe->objects}) {
    for (const RecipeAssets& one : *assets) {
      if (one.inputs.empty() || one.place.empty()) reportFinding("assets of no files or no place");
    }
  }
  for (const GivenOption& option : recipe->common) {
    if (option.place.empty()) reportFinding("an option of no place");
  }
}

template <class... T>
void expectFinite(T... values) {
  if (!(std::isfinite(values) && ...)) reportFinding("a number of a recipe that is not finite");
}

void readRobot(const std::filesystem::path& path) {
  static const SourceRobot robot = test::smallRobot();
  const auto recipe = readRobotRecipe(path);
  if (!recipe) return expectGoodError(recipe.error());
  if (recipe->name.empty() || recipe->end_effector.link.name.empty()) {
    reportFinding("a recipe without names");
  }
  for (const double coordinate : recipe->end_effector.grasp_point) expectFinite(coordinate);
  const RecipeBase& base = recipe->base;
  expectFinite(recipe->end_effector.grasp_radius, base.forward_step, base.turn_step,
               base.root_height, recipe->spheres.eps, recipe->spheres.tau);
  for (const RecipeJoint& joint : recipe->joints) {
    expectFinite(joint.step, joint.min.value_or(0), joint.max.value_or(0));
  }
  for (const RecipeStart& start : recipe->start_pose) expectFinite(start.position);
  if (const auto fits = checkRecipe(*recipe, robot); !fits) expectGoodError(fits.error());
}

/// The command line needs no place: it is that of whoever typed it.
void readConfig(const std::filesystem::path& path) {
  constexpr std::array kKinds{"scene", "object", "robot", "episodes", "world", "dataset"};
  for (const char* kind : kKinds) {
    const auto command = commandFrom({"--as", kind, "--config", path.string(), "input"});
    if (command) continue;
    if (command.error().code == ErrorCode::kInternal) reportFinding(command.error().message);
    if (command.error().message.empty()) reportFinding("an error without message");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const galactic::test::ScratchFolder folder;
  constexpr std::array kReaders{readWorld, readRobot, readConfig};
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  kReaders[data[0] % kReaders.size()](folder.write("file.toml", text));
  return 0;
}
