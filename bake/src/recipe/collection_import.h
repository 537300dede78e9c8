#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "galactic/bake/robot_recipe.h"
#include "galactic/bake/source_robot.h"
#include "galactic/error.h"
#include "robot_description/hand_spheres.h"

namespace galactic::bake {

/// How the published simulator makes an object's spheres.
enum class SphereTechnique { kListed, kBox, kUprightCylinder };

/// A movable object of a collection, in the frame of its mesh file; meters.
struct CollectionObject {
  std::string name;
  std::array<double, 3> box_min{};
  std::array<double, 3> box_max{};
  SphereTechnique technique = SphereTechnique::kListed;
  /// Only for kListed.
  std::vector<HandSphere> spheres;
};

/// A joint that an action moves; `dof` is its number among the movable joints, see
/// recipeFromCollection.
struct CollectionJoint {
  std::uint32_t dof = 0;
  double step = 0;
};

struct CollectionRobot {
  /// The path as the file states it.
  std::string urdf;
  std::vector<double> start_positions;
  std::string gripper_link;
  std::array<double, 3> gripper_offset{};
  double gripper_radius = 0;
  std::optional<double> forward_step;
  std::optional<double> turn_step;
  std::vector<CollectionJoint> joints;
  /// Y up and X forward, as in the file.
  std::vector<LinkSpheres> links;
};

/// A published `*.collection.json`: the sphere radii, the objects' boxes and the robot.
struct Collection {
  std::string source;
  std::vector<double> radii;
  std::vector<CollectionObject> objects;
  std::optional<CollectionRobot> robot;
  /// One sentence for each key that is not used.
  std::vector<std::string> warnings;
};

/// Reads a collection file. Fails with kIo or kInvalidInput, naming the file and the element, on
/// broken JSON, missing keys, wrong types, numbers out of range, or more than one robot.
[[nodiscard]] Result<Collection> readCollection(const std::filesystem::path& path);

struct CollectionRecipe {
  RobotRecipe recipe;
  std::vector<std::string> warnings;
};

/// The recipe equivalent to the collection's robot. The collection identifies joints by number: the
/// published simulator counts the movable joints depth first, with children sorted by joint name.
/// The file has no camera: if the robot has the link of the published training camera
/// (head_pan_link), the recipe gets that camera. The footprint is the circle around the root's
/// spheres. Links without spheres in the file are skipped. Fails with kInvalidInput if the
/// collection has no robot, or one that does not fit `robot`.
[[nodiscard]] Result<CollectionRecipe> recipeFromCollection(const Collection& collection,
                                                            const SourceRobot& robot);

}  // namespace galactic::bake
