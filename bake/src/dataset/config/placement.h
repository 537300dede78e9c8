#pragma once
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "dataset/config/scene_instance.h"
#include "dataset/config/template_attributes.h"
#include "galactic/bake/source_asset.h"
#include "galactic/bake/source_robot.h"

namespace galactic::bake {

/// The rotation that turns the template's `up` to +Y and its `front` to -Z, then its scale and the
/// instance's. Needs up and front at right angles.
[[nodiscard]] Affine objectFromAsset(const TemplateAttributes& attributes,
                                     const std::array<double, 3>& instance_scale);

/// Translation and rotation of an instance.
[[nodiscard]] Affine worldFromObject(const SceneItem& item);

/// The center of the box around `asset` as `object_from_asset` places it: around the placed box of
/// each mesh, as Habitat computes it.
[[nodiscard]] std::array<double, 3> boxCenter(const SourceAsset& asset,
                                              const Affine& object_from_asset);

[[nodiscard]] Affine translationBy(const std::array<double, 3>& offset);

/// Where the links of `furniture` are, seen from its root, one for each: all joints at 0, or at the
/// nearest end of their limits, but for those in `positions`. These are by name of joint, where all
/// of them are such names, else for the joints with one position in the order of a walk through the
/// tree, children by name of joint. Radians and meters.
[[nodiscard]] std::vector<Affine> restPose(
    const SourceRobot& furniture, const std::vector<std::pair<std::string, double>>& positions);

}  // namespace galactic::bake
