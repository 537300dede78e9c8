#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dataset/config/receptacles.h"
#include "dataset/config/template_list.h"
#include "galactic/error.h"

namespace galactic::bake {

/// What the translation of an instance places.
enum class TranslationOrigin : std::uint8_t { kCenterOfMass, kAssetOrigin };

/// How an instance may move.
enum class MotionType : std::uint8_t { kStatic, kKinematic, kDynamic };

/// One thing that a scene places.
struct SceneItem {
  std::string template_name;
  /// Meters, world frame.
  std::array<double, 3> translation{};
  /// (w, x, y, z), of length 1.
  std::array<double, 4> rotation{1, 0, 0, 0};
  /// Along the axes of the template after its `up` and `front`; uniform and non-uniform scale.
  std::array<double, 3> scale{1, 1, 1};
  /// None: as the scene says.
  std::optional<TranslationOrigin> origin;
  /// Habitat takes what states none for dynamic.
  MotionType motion = MotionType::kDynamic;
  /// Of articulated objects: by the name of a joint, or in the order of the names. Radians, meters.
  std::vector<std::pair<std::string, double>> joint_positions;
  /// Stated over those of the template.
  ReceptacleTexts receptacles;
};

/// A scene as its file states it.
struct SceneInstance {
  /// None: the scene says that it has none ("NONE").
  std::optional<SceneItem> stage;
  std::vector<SceneItem> objects;
  std::vector<SceneItem> articulated;
  TranslationOrigin origin = TranslationOrigin::kCenterOfMass;
  /// Of the scene itself.
  ReceptacleTexts receptacles;
};

/// Reads a scene from what is stated about it, each layer over what came before; members of no
/// concern here (lights, navigation meshes and so on) are passed over. Fails with kInvalidInput.
[[nodiscard]] Result<SceneInstance> readSceneInstance(std::span<const AttributeLayer> layers);

}  // namespace galactic::bake
