#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "robot_description/description.h"

namespace galactic::bake {

/// A link's place in the tree.
struct TreeLink {
  /// Index into RobotDescription::links.
  std::size_t link = 0;
  /// Position in the list of the parent; -1 for the root.
  int parent = -1;
  /// Index into RobotDescription::joints of the joint to the parent; none for the root.
  std::optional<std::size_t> joint;
};

/// The links, with the root first and parents before their children (depth first, children in the
/// order of the model's joints). Fails with kInvalidInput unless the joints connect all links into
/// one tree.
[[nodiscard]] Result<std::vector<TreeLink>> orderTree(const RobotDescription& model,
                                                      const std::string& where);

/// Checks the numbers of joints: finite, within bounds, limits in order, axes with a direction.
/// Normalizes the axes, and adds doubtful values to `warnings`.
[[nodiscard]] Result<void> checkJoints(RobotDescription& model, const std::string& where,
                                       std::vector<std::string>& warnings);

}  // namespace galactic::bake
