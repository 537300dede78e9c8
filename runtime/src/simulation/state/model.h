#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"
#include "sensors/geodesic.h"
#include "sensors/laser.h"
#include "simulation/collision/clearance_map.h"
#include "simulation/collision/collision.h"
#include "simulation/collision/level_floors.h"
#include "simulation/collision/resting_objects_kernels.h"
#include "simulation/collision/sphere_bits.h"
#include "simulation/motion/motion_kernels.h"
#include "simulation/motion/motion_model.h"
#include "simulation/ways_out/free_slices.h"
#include "support/huge_pages.h"
#include "support/option_rules.h"
#include "support/optional_index.h"

namespace galactic::simulation {

/// world_from_grip and the base's heading, as the motion kernels write them: see BodyArrays.
using GripFrame = std::array<float, kGripStride>;

struct Model;
class BatchState;

/// A range of a batch's envs.
struct EnvRange {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// A part of an observation that the kernels do not write.
struct SensedPart {
  /// Its first element in a row.
  std::size_t first = 0;
  std::size_t size = 0;
  /// Writes `part` to the observations of `envs`.
  void (*write)(const Model& model, BatchState& state, EnvRange envs,
                const SensedPart& part) = nullptr;
};

/// The state of an env when an episode begins.
struct EpisodeStart {
  /// Index into the episode set.
  std::uint32_t episode = 0;
  /// Base in the world frame; y is the floor's height.
  Vec3 base;
  float yaw = 0;
  GripFrame grip{};
  /// Number of its floor's map in Model::clearance.
  std::uint32_t clearance_map = kNoClearanceMap;
  /// Its first elements in Model::start_bounds and Model::start_boxes, and the number of its
  /// objects.
  std::size_t first_bounds = 0;
  std::size_t first_box = 0;
  std::size_t objects = 0;
};

/// Everything that never changes in a run: computed once, shared by all threads.
struct Model {
  std::optional<World> world;
  /// The world's scenes, at hand because each step looks up that of each env.
  std::span<const Scene> scenes;
  SimulationOptions options;
  MotionModel motion;
  MotionKernels kernels;
  MotionTables tables;
  /// Episodes that can be started, ascending; `skipped` has those that cannot.
  std::vector<EpisodeStart> starts;
  /// Values of the variables at each start. Shape: starts * variables.
  std::vector<float> start_variables;
  /// Body transforms at each start. Shape: starts * bodyCount().
  std::vector<RigidTransform> start_bodies;
  /// Bounds and boxes of the objects at all starts, which envs share until they move one.
  std::pmr::vector<PackedBounds> start_bounds{detail::hugePages()};
  std::pmr::vector<RestingBox> start_boxes{detail::hugePages()};
  std::vector<std::uint32_t> skipped;
  /// The robot's spheres in groups of eight.
  std::vector<EightSpheres> groups;
  /// Maps with one lane per group, padded to whole eights, then one per radius of the working set
  /// for what the robot holds.
  ClearanceMaps clearance;
  /// Slices of the same floors, with the same numbers.
  FreeSlices slices;
  LevelFloors level_floors;
  std::size_t most_objects = 0;
  /// Spheres of the largest object, padded to lanes.
  std::size_t most_held_spheres = 0;
  std::vector<ObservationPart> observation;
  std::size_t observation_size = 0;
  /// The last parts of a row.
  std::vector<SensedPart> sensed;
  sensors::Laser laser;
  /// Indexed by start; off unless geodesic distances are observed or rewarded.
  sensors::Geodesic geodesic;

  /// Bytes of everything that grows with the world, that is with scenes and episodes.
  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] ActionLayout actionLayout() const {
    return {motion.controlled.size(), motion.base.sideways_step > 0};
  }
  [[nodiscard]] std::size_t actionCount() const { return actionLayout().count(); }
  [[nodiscard]] std::size_t variableCount() const { return motion.variables.size(); }
  /// Whether robots know their place from odometry only.
  [[nodiscard]] bool hasOdometry() const { return options.noise.localization.most > 0; }
  /// The number of past steps whose actions are kept, because actions may arrive late or be
  /// observed.
  [[nodiscard]] std::size_t keptSteps() const {
    return std::max(options.noise.action_delay.most, options.sensors.last_actions);
  }
  /// Spheres of the robot, padded to lanes.
  [[nodiscard]] std::size_t sphereCount() const { return motion.spheres.size(); }
  /// The number of root and nodes, or 0 unless the run wants their poses.
  [[nodiscard]] std::size_t bodyCount() const {
    return options.body_transforms ? motion.nodes.size() + 1 : 0;
  }
  /// The env's number over all ranks, on which its random numbers and episodes depend.
  [[nodiscard]] std::uint32_t globalEnv(std::size_t env) const {
    return firstEnvOf(options) + static_cast<std::uint32_t>(env);
  }
  /// 64-bit words that hold one bit for each sphere of a held object.
  [[nodiscard]] std::size_t heldWords() const { return wordsFor(most_held_spheres); }
  /// The same for the robot.
  [[nodiscard]] std::size_t bodyWords() const { return wordsFor(sphereCount()); }
  [[nodiscard]] const Episode& episodeOf(std::uint32_t start) const {
    return world->episodes().episodes()[starts[start].episode];
  }
  /// The index into `starts` of the episode with this index in the world; none if there is no such
  /// episode or it is skipped.
  [[nodiscard]] OptionalIndex startOf(std::int64_t episode) const noexcept;
  [[nodiscard]] PresentObjects present(const Episode& episode) const {
    return world->episodes().present(episode, options.task.distractors);
  }
  [[nodiscard]] std::span<const Placement> placements(const Episode& episode) const {
    return present(episode).placements;
  }
  /// The resting objects at a start.
  [[nodiscard]] RestingView objectsAt(std::uint32_t start) const {
    const EpisodeStart& at = starts[start];
    return {start_bounds.data() + at.first_bounds, packsFor(at.objects),
            start_boxes.data() + at.first_box, at.objects};
  }
  /// Object `number` of the episode of `start`.
  [[nodiscard]] const ObjectModel& object(std::uint32_t start, std::uint32_t number) const {
    return world->objectOf(placements(episodeOf(start))[number]);
  }
};

}  // namespace galactic::simulation
