#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/sources/robot_model.h"
#include "dynamics/world.h"
#include "galactic/bake/assets.h"
#include "galactic/bake/job_lists.h"
#include "galactic/error.h"
#include "galactic/world.h"

namespace galactic::dynamics {

/// What a world's packs do not contain: triangles, hulls and masses, by the names in the packs.
/// Shapes are immutable; worlds on several threads share them.
struct Sources {
  std::map<std::string, std::shared_ptr<const SceneShape>, std::less<>> scenes;
  std::map<std::string, std::shared_ptr<const ObjectShape>, std::less<>> objects;
  RobotParts robot;
  std::shared_ptr<const RobotShape> robot_shape;
  /// The recipe, the files that it names, even if the world does not use them, and the files to
  /// which those that were read refer. Entries of files that were read have their content: see
  /// digestOf().
  bake::ReadLog log;
  /// One sentence for each thing that was missing and its substitute, and for each file that
  /// differs from the one from which a pack was baked.
  std::vector<std::string> warnings;
};

/// Mass of objects for which none is given, kilograms. The episode generator uses the same.
inline constexpr double kObjectMass = 0.5;

/// Reads the files from which the robot of `world` was baked, and the scenes and objects that its
/// episodes use; episodes in `source` are ignored. Fails with the errors of the recipe and the
/// importers, and with kInvalidInput if the recipe does not make something that the world has.
[[nodiscard]] Result<Sources> readSources(const bake::RecipeSource& source, const World& world);

}  // namespace galactic::dynamics
