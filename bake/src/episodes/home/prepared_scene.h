#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "episodes/episode_draft.h"
#include "episodes/generation_world.h"

namespace galactic::bake {

/// The parts of a generation that all scenes share.
struct GenerationContext {
  const GenerationWorld& world;
  const ArmReach& reach;
  /// One per object if objects are settled; else empty.
  std::span<const SettlingBody> bodies;
  const EpisodeGeneratorOptions& options;
};

/// Everything that is computed once for a scene before its episodes are drawn; takes most of the
/// memory of a generation. Must not move, because its parts refer to each other.
class PreparedScene {
 public:
  /// Fails with kInvalidInput if the mesh does not cover the scene.
  [[nodiscard]] static Result<std::unique_ptr<const PreparedScene>> prepare(
      const GenerationContext& context, const Scene& scene, SceneDetails details);

  /// Why there can be no episodes: the robot can stand nowhere, the requested receptacles are
  /// missing, no surface is within reach, or no places were found that hold a target and, at the
  /// requested distance, its goal. Empty if there can be episodes.
  [[nodiscard]] const std::string& unusable() const { return unusable_; }

  /// The data for drafts; valid as long as this. Only for usable scenes.
  [[nodiscard]] DraftHome draftHome() const;
  /// Pairs of places where a target and its goal were found to stand; not empty for usable scenes.
  [[nodiscard]] const std::vector<ProvenPair>& provenPairs() const { return proven_; }

  /// Without the number of episodes.
  [[nodiscard]] GeneratedScene summary() const;

 private:
  PreparedScene(const GenerationContext& context, const Scene& scene, SceneDetails details);
  [[nodiscard]] std::string whyUnusable() const;
  /// GeneratedScene::bumpy_places.
  [[nodiscard]] std::size_t bumpyPlaces() const;
  Result<void> useMesh();
  /// An upper bound of how far apart two objects can be, meters, and not much more than that.
  [[nodiscard]] float widestWay() const;
  void chooseWay();
  /// Finds proven pairs. If there are none at the requested distance, tries shorter ones if that is
  /// allowed; without any the scene is unusable.
  void survey();

  const GenerationContext& context_;
  const Scene& scene_;
  SceneDetails details_;
  FloorMap floor_;
  SupportPlaces supports_;
  DistanceRange target_to_goal_;
  std::string unusable_;
  std::unique_ptr<const SurfaceRays> rays_;
  std::unique_ptr<const SettlingScene> settling_;
  std::vector<ProvenPair> proven_;
};

}  // namespace galactic::bake
