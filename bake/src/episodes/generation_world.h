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
  /// Of the files that it was baked from.
  std::uint64_t source_bytes = 0;
};

/// The packs of a generation, opened, by name: nothing depends on the order in which they came.
class GenerationWorld {
 public:
  /// Fails with kInvalidInput when the packs do not go together: not one robot, no scene, no
  /// object, one name twice, other radii, a robot that cannot do the task, another kind of pack.
  [[nodiscard]] static Result<GenerationWorld> open(std::span<const PackFile* const> packs);

  /// Ascending names.
  [[nodiscard]] const std::vector<SceneOfPack>& scenes() const { return scenes_; }
  [[nodiscard]] const std::vector<ObjectModel>& objects() const { return objects_; }
  [[nodiscard]] const Robot& robot() const { return robot_.front(); }

  /// The packs of all objects, and of the robot.
  [[nodiscard]] const std::vector<const PackFile*>& commonPacks() const { return common_packs_; }

  /// The shape of each object: the hull of its render mesh, or its box where it has none.
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
