#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "episodes/trial/settling.h"
#include "galactic/error.h"
#include "galactic/object_set.h"
#include "galactic/pack.h"
#include "galactic/robot.h"
#include "galactic/scene.h"

namespace galactic::bake {

/// A scene and its pack.
struct SceneOfPack {
  const PackFile* pack = nullptr;
  Scene scene;
  /// Size of the files that it was baked from.
  std::uint64_t source_bytes = 0;
};

/// The opened packs of a generation, sorted by name, so that nothing depends on the order in which
/// they are given.
class GenerationWorld {
 public:
  /// Fails with kInvalidInput if the packs do not fit together: no robot or several, no scene, no
  /// object, a name that occurs twice, different radii, a robot that cannot do the task, or a pack
  /// of another kind. Ignores packs of textures.
  [[nodiscard]] static Result<GenerationWorld> open(std::span<const PackFile* const> packs);

  /// By ascending name.
  [[nodiscard]] const std::vector<SceneOfPack>& scenes() const { return scenes_; }
  [[nodiscard]] const std::vector<ObjectModel>& objects() const { return objects_; }
  [[nodiscard]] const Robot& robot() const { return robot_.front(); }

  /// The packs of all objects and of the robot.
  [[nodiscard]] const std::vector<const PackFile*>& commonPacks() const { return common_packs_; }

  /// The shape of each object: the hull of its render mesh, or its box if it has none.
  [[nodiscard]] Result<std::vector<SettlingBody>> settlingBodies() const;

 private:
  GenerationWorld() = default;
  Result<void> add(const PackFile& pack);
  Result<void> addObjects(const PackFile& pack);
  [[nodiscard]] Result<void> check() const;

  std::vector<SceneOfPack> scenes_;
  std::vector<ObjectSet> sets_;
  std::vector<ObjectModel> objects_;
  /// One; a vector because it cannot be made empty.
  std::vector<Robot> robot_;
  std::vector<const PackFile*> common_packs_;
};

}  // namespace galactic::bake
