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

/// What a world's packs lack: triangles, hulls and masses, by the names in the packs. Shapes are
/// immutable; worlds on several threads share them.
struct Sources {
  std::map<std::string, std::shared_ptr<const SceneShape>, std::less<>> scenes;
  std::map<std::string, std::shared_ptr<const ObjectShape>, std::less<>> objects;
  RobotParts robot;
  std::shared_ptr<const RobotShape> robot_shape;
  /// The recipe and the files that it names, also those that the world does not use, and what those
  /// that were read refer to. Those that were read have their content: see digestOf().
  bake::ReadLog log;
  /// What was missing and what is taken instead, and which files are not those that the packs were
  /// baked from, one sentence each.
  std::vector<std::string> warnings;
};

/// Kilograms of objects whose mass nothing tells. Also the episode generator's.
inline constexpr double kObjectMass = 0.5;

/// Reads what the scenes, objects and the robot of `world` were baked from; of scenes and objects
/// only those that its episodes use, whatever `source` says of episodes. Fails with the errors of
/// the recipe and the importers, and with kInvalidInput where the recipe makes no pack of something
/// that the world has.
[[nodiscard]] Result<Sources> readSources(const bake::RecipeSource& source, const World& world);

}  // namespace galactic::dynamics
