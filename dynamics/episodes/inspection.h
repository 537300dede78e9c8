#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/episodes/comparison.h"
#include "dynamics/episodes/trace.h"
#include "dynamics/world.h"
#include "galactic/planning_scene.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"

namespace galactic::dynamics {

/// Checks the contacts in the simulation, step by step, against triangles and hulls.
class Inspection {
 public:
  /// All arguments must outlive the object. `setup`, `objects`: at the start of the episode.
  Inspection(const EpisodeTrace& trace, const World& world, const SimulationOptions& simulation,
             std::shared_ptr<const SceneShape> scene, std::span<const PlacedObject> objects,
             const RobotSetup& setup);

  /// Adds up the contacts of all steps.
  void run(EpisodeComparison& result);

 private:
  void inspect(std::size_t step, EpisodeComparison& result);
  void judgeHindered(std::size_t step, EpisodeComparison& result);
  void judgeMissed(std::size_t step, EpisodeComparison& result);
  void judgeBetween(std::size_t step, EpisodeComparison& result);
  void takeReleases(std::size_t step);

  struct RobotPose {
    Pose world_from_root;
    std::vector<float> positions;
  };
  [[nodiscard]] RobotPose before(std::size_t step) const;
  [[nodiscard]] bool counts(const RobotContact& contact, float depth, float ground) const;
  [[nodiscard]] float groundUnder(const Pose& world_from_root) const;
  [[nodiscard]] MissCause causeOf(const RobotContact& contact, const RobotPose& pose);
  [[nodiscard]] InventedCause inventedCauseOf(std::size_t step, const RobotPose& wanted);

  const EpisodeTrace& trace_;
  const World& world_;
  const SimulationOptions& simulation_;
  ContactProbe probe_;
  PlanningScene planning_;
  std::vector<Pose> world_from_link_;
  /// An object that the hand has released but not left yet.
  std::optional<std::size_t> leaving_;
  /// Whether the pose before the step touches something.
  bool touched_before_ = false;
};

}  // namespace galactic::dynamics
