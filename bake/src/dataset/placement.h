#pragma once
#include <array>

#include "dataset/scene_instance.h"
#include "dataset/template_attributes.h"
#include "galactic/bake/source_asset.h"

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

}  // namespace galactic::bake
