#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
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

/// Everything in a world that can be drawn: the models of all its packs, and which model shows
/// what. Immutable, so safe to share between threads. Copies are cheap and share their content,
/// which keeps the world alive. Indices of scenes or objects that are out of range throw
/// ErrorException with kInvalidInput.
class WorldModels {
 public:
  /// Fails with kInvalidInput if a pack was baked without render meshes.
  [[nodiscard]] static Result<WorldModels> from(const World& world);

  /// World::hash() of the world.
  [[nodiscard]] std::uint64_t worldHash() const { return content_->world_hash; }
  [[nodiscard]] const RenderLibrary& library() const { return content_->library; }
  /// The model of a scene (index into World::scenes()); none if it has nothing to show.
  [[nodiscard]] std::optional<std::uint32_t> sceneModel(std::uint32_t scene) const;
  /// The model of an object (index into EpisodeSet::objectNames()).
  [[nodiscard]] std::optional<std::uint32_t> objectModel(std::uint32_t object) const;
  /// By ascending link.
  [[nodiscard]] const std::vector<LinkModel>& links() const { return content_->links; }

 private:
  struct Content {
    std::uint64_t world_hash = 0;
    RenderLibrary library;
    std::vector<std::optional<std::uint32_t>> scenes;
    std::vector<std::optional<std::uint32_t>> objects;
    std::vector<LinkModel> links;
  };

  explicit WorldModels(std::shared_ptr<const Content> content) : content_(std::move(content)) {}

  std::shared_ptr<const Content> content_;
};

}  // namespace galactic
