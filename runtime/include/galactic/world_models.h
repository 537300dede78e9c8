#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "galactic/error.h"
#include "galactic/render_library.h"
#include "galactic/world.h"

namespace galactic {

/// A link of the robot that has something to show.
struct LinkModel {
  /// Index into Robot::links().
  std::uint32_t link = 0;
  /// Number in the library.
  std::uint32_t model = 0;
};

/// What a world has to draw: the models of all its packs, and which of them shows what. Movable;
/// immutable, so safe to share between threads.
class WorldModels {
 public:
  /// Fails with kInvalidInput when a pack was baked without render meshes.
  [[nodiscard]] static Result<WorldModels> from(const World& world);

  [[nodiscard]] const RenderLibrary& library() const { return library_; }
  /// The model of a scene (index into World::scenes()); none when it has nothing to show.
  [[nodiscard]] std::optional<std::uint32_t> sceneModel(std::uint32_t scene) const {
    return scenes_[scene];
  }
  /// The model of an object (index into EpisodeSet::objectNames()).
  [[nodiscard]] std::optional<std::uint32_t> objectModel(std::uint32_t object) const {
    return objects_[object];
  }
  /// Ascending links.
  [[nodiscard]] const std::vector<LinkModel>& links() const { return links_; }

 private:
  explicit WorldModels(const World& world) : world_(world) {}

  /// What the library looks at.
  World world_;
  RenderLibrary library_;
  std::vector<std::optional<std::uint32_t>> scenes_;
  std::vector<std::optional<std::uint32_t>> objects_;
  std::vector<LinkModel> links_;
};

}  // namespace galactic
