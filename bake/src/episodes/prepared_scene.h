#pragma once
#include <memory>
#include <span>

#include "episodes/episode_draft.h"
#include "episodes/generation_world.h"

namespace galactic::bake {

/// What all scenes share.
struct GenerationContext {
  const GenerationWorld& world;
  const ArmReach& reach;
  /// One per object, where objects are settled.
  std::span<const SettlingBody> bodies;
  const EpisodeGeneratorOptions& options;
};

/// What is worked out once for a scene before its episodes are drawn: most of the memory of a
/// generation. Stays where it is: its parts know each other.
class PreparedScene {
 public:
  /// Fails with kInvalidInput when the robot stands nowhere, when the receptacles that were asked
  /// for are missing, when no surface is within reach, and when the mesh is of another place.
  [[nodiscard]] static Result<std::unique_ptr<const PreparedScene>> prepare(
      const GenerationContext& context, const Scene& scene, SceneDetails details);

  /// What drafts read; valid as long as this.
  [[nodiscard]] Stage stage() const;
  /// Without the number of episodes.
  [[nodiscard]] GeneratedScene summary() const;

 private:
  PreparedScene(const GenerationContext& context, const Scene& scene, SceneDetails details);
  [[nodiscard]] Result<void> check() const;
  Result<void> useMesh();

  const GenerationContext& context_;
  const Scene& scene_;
  SceneDetails details_;
  FloorMap floor_;
  SupportPlaces supports_;
  std::unique_ptr<const SurfaceRays> rays_;
  std::unique_ptr<const SettlingScene> settling_;
};

}  // namespace galactic::bake
