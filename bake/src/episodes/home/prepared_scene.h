#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

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
  /// Fails with kInvalidInput when the mesh is of another place.
  [[nodiscard]] static Result<std::unique_ptr<const PreparedScene>> prepare(
      const GenerationContext& context, const Scene& scene, SceneDetails details);

  /// Why there can be no episodes: the robot stands nowhere, the receptacles that were asked for
  /// are missing, no surface is within reach, or no places were found that hold a target and, at
  /// the distance that is asked for, its goal. Empty when there can be.
  [[nodiscard]] const std::string& unusable() const { return unusable_; }

  /// What drafts read; valid as long as this. Only of a scene that is not unusable.
  [[nodiscard]] DraftHome draftHome() const;
  /// Places at which a target and its goal were seen to stand; some, unless it is unusable.
  [[nodiscard]] const std::vector<ProvenPair>& provenPairs() const { return proven_; }

  /// Without the number of episodes.
  [[nodiscard]] GeneratedScene summary() const;

 private:
  PreparedScene(const GenerationContext& context, const Scene& scene, SceneDetails details);
  [[nodiscard]] std::string whyUnusable() const;
  /// GeneratedScene::bumpy_places.
  [[nodiscard]] std::size_t bumpyPlaces() const;
  Result<void> useMesh();
  /// How far apart two objects can be, meters: a little more than is possible, never less.
  [[nodiscard]] float widestWay() const;
  void chooseWay();
  /// Finds proven pairs, nearer ones where none are as far apart as is asked for and that is
  /// allowed; without any it is unusable.
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
