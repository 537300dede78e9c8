#include "simulation/simulator/model_making.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "simulation/phases/chunk.h"
#include "simulation/phases/contacts.h"
#include "simulation/phases/move.h"
#include "simulation/phases/observe.h"
#include "simulation/phases/slide.h"
#include "simulation/simulator/floor_maps.h"
#include "simulation/state/batch_state.h"
#include "support/option_rules.h"
#include "support/threads/workers.h"
#include "support/try.h"

namespace galactic::simulation {
namespace {

/// The number of an object's spheres in a SphereBatch: each radius is padded to whole groups of
/// lanes.
std::size_t paddedSpheres(const ObjectModel& object, std::size_t radii) {
  std::size_t padded = 0;
  for (std::uint32_t radius = 0; radius < radii; ++radius) {
    padded += paddedToLanes(static_cast<std::size_t>(
        std::ranges::count(object.spheres, radius, &SetSphere::radius_index)));
  }
  return padded;
}

void measure(const World& world, Model& model) {
  model.most_objects = model.options.task.distractors ? world.mostObjects() : 1;
  for (const Episode& episode : world.episodes().episodes()) {
    for (const Placement& placement : model.placements(episode)) {
      model.most_held_spheres = std::max(
          model.most_held_spheres, paddedSpheres(world.objectOf(placement), world.radii().size()));
    }
  }
}

/// Tries the episodes one after another in the first env of a batch of one chunk.
class StartFinder {
 public:
  explicit StartFinder(Model& model) : model_(model), state_(model, 1), chunk_(model) {}

  void find() {
    const World& world = *model_.world;
    const std::size_t count = world.episodes().episodes().size();
    model_.starts.reserve(count);
    model_.start_variables.reserve(count * model_.variableCount());
    std::size_t packs = 0;
    std::size_t objects = 0;
    for (const Episode& episode : world.episodes().episodes()) {
      packs += packsFor(model_.placements(episode).size());
      objects += model_.placements(episode).size();
    }
    model_.start_bounds.reserve(packs);
    model_.start_boxes.reserve(objects);
    for (std::uint32_t n = 0; n < count; ++n) {
      if (!tryEpisode(n)) model_.skipped.push_back(n);
    }
  }

  /// Heights of the robot's sphere centers at the starts.
  [[nodiscard]] const HeightsOverFloor& heights() const { return heights_; }

 private:
  void setVariables(std::uint32_t episode) {
    const World& world = *model_.world;
    const std::span<const float> recipe = world.robot().startPositions();
    const std::span<const float> given = world.episodes().startPositions(episode);
    const std::span<const std::uint32_t> positions = world.startPositionIndices();
    const PoseArrays pose = chunk_.candidates(0);
    for (std::size_t v = 0; v < model_.variableCount(); ++v) {
      const MotionVariable& variable = model_.motion.variables[v];
      float value = recipe[variable.position];
      for (std::size_t n = 0; n < positions.size(); ++n) {
        if (positions[n] == variable.position) value = given[n];
      }
      pose.variables[v * pose.stride] = within(variable, value);
    }
  }

  /// Puts the base on the floor at the episode's base position, or further down. Returns false if
  /// the floor is too deep or unknown.
  bool setBase(const Episode& episode) {
    const FloorUnder under = floorUnderStart(model_.world->sceneOf(episode), episode.base_position,
                                             model_.options.ground);
    const PoseArrays pose = chunk_.candidates(0);
    *pose.x = episode.base_position.x;
    *pose.y = under.height;
    *pose.z = episode.base_position.z;
    // A yaw of an episode may have any number of turns; the motion kernels expect less than one.
    constexpr double kTurn = 6.283185307179586;
    *pose.yaw = static_cast<float>(std::remainder(static_cast<double>(episode.base_yaw), kTurn));
    // The robot did not drive there, so it comes from the same place.
    *state_.poses(0).x = episode.base_position.x;
    *state_.poses(0).y = under.height;
    *state_.poses(0).z = episode.base_position.z;
    chunk_.floor(0) = under.floor;
    return under.floor != Floor::kDrops;
  }

  void setObjects(const Episode& episode) {
    RestingObjects& resting = state_.resting(0);
    const std::uint32_t scene = model_.world->sceneIndexOf(episode);
    resting.clear();
    std::uint32_t number = 0;
    for (const Placement& placement : model_.placements(episode)) {
      resting.insert(number++, restingBox(model_.world->objectOf(placement).box, placement.pose));
    }
    state_.env(0).scene = scene;
  }

  /// Stores the objects that setObjects() has laid to rest.
  void keepObjects(std::size_t count) {
    const RestingView& objects = state_.resting(0).view();
    EpisodeStart& start = model_.starts.back();
    start.first_bounds = model_.start_bounds.size();
    start.first_box = model_.start_boxes.size();
    start.objects = count;
    model_.start_bounds.insert(model_.start_bounds.end(), objects.bounds,
                               objects.bounds + packsFor(count));
    model_.start_boxes.insert(model_.start_boxes.end(), objects.boxes, objects.boxes + count);
  }

  bool tryEpisode(std::uint32_t n) {
    const Episode& episode = model_.world->episodes().episodes()[n];
    setVariables(n);
    if (!setBase(episode)) return false;
    setObjects(episode);
    const ChunkStep step{model_, state_, chunk_, 0};
    placeBodies(step);
    const Hindrance met = hindranceOf(step, 0);
    if (met != Hindrance::kNone && !slideClear(step, 0, met)) return false;
    const PoseArrays pose = chunk_.candidates(0);
    const float floor = chunk_.base(0).y;
    heights_.lowest = std::min(heights_.lowest, chunk_.lowest(0) - floor);
    heights_.highest = std::max(heights_.highest, chunk_.highest(0) - floor);
    model_.starts.push_back({n, chunk_.base(0), *pose.yaw, chunk_.grip(0)});
    keepObjects(model_.placements(episode).size());
    keepBodies(step, {~std::uint32_t{0}});
    const std::span<const RigidTransform> bodies = state_.bodyTransforms(0);
    model_.start_bodies.insert(model_.start_bodies.end(), bodies.begin(), bodies.end());
    for (std::size_t v = 0; v < model_.variableCount(); ++v) {
      model_.start_variables.push_back(pose.variables[v * pose.stride]);
    }
    return true;
  }

  Model& model_;
  BatchState state_;
  Chunk chunk_;
  HeightsOverFloor heights_{.lowest = std::numeric_limits<float>::infinity(),
                            .highest = -std::numeric_limits<float>::infinity()};
};

/// The radii of the lanes that maps are asked about: one per group of the robot, padded to whole
/// eights, then all radii for held objects.
std::vector<std::uint32_t> radiiOfLanes(const Model& model) {
  std::vector<std::uint32_t> radii;
  for (const EightSpheres& group : model.groups) radii.push_back(group.radius_index);
  radii.resize(paddedToLanes(radii.size()), radii.front());
  for (std::uint32_t radius = 0; radius < model.world->radii().size(); ++radius) {
    radii.push_back(radius);
  }
  return radii;
}

/// The floor of each start; starts on the same floor repeat it.
std::vector<sensors::StoodOn> floorsOf(const Model& model) {
  std::vector<sensors::StoodOn> floors;
  floors.reserve(model.starts.size());
  for (std::uint32_t start = 0; start < model.starts.size(); ++start) {
    floors.push_back(
        {model.world->sceneIndexOf(model.episodeOf(start)), model.starts[start].base.y});
  }
  return floors;
}

/// The errand of each start.
std::vector<sensors::Errand> errandsOf(const Model& model) {
  std::vector<sensors::Errand> errands;
  errands.reserve(model.starts.size());
  for (std::uint32_t start = 0; start < model.starts.size(); ++start) {
    const Episode& episode = model.episodeOf(start);
    const Placement& target = model.world->episodes().placements(episode)[episode.target];
    errands.push_back({.scene = model.world->sceneIndexOf(episode),
                       .base = model.starts[start].base,
                       .target = target.pose.translation,
                       .goal = episode.goal.translation});
  }
  return errands;
}

/// Makes what sensors know of the world. Call after the starts have been found.
Result<void> makeSensors(const sensors::LaserSettings& laser, Model& model) {
  const SimulationOptions& options = model.options;
  const std::uint32_t threads = detail::threadCount(options.threads);
  ASSIGN_OR_RETURN(sensors::Laser made,
                   sensors::Laser::make(laser, *model.world, floorsOf(model), threads));
  model.laser = std::move(made);
  if (!findsPaths(options)) return {};
  const sensors::StandingRobot robot(model.world->robot(), model.motion, model.kernels);
  ASSIGN_OR_RETURN(sensors::Geodesic ways,
                   sensors::Geodesic::make(*model.world, robot, options.ground, errandsOf(model),
                                           options.sensors.geodesic_megabytes, threads));
  model.geodesic = std::move(ways);
  return {};
}

}  // namespace

Result<Model> makeModel(const World& world, const SimulationOptions& options) {
  Model model;
  model.world = world;
  model.scenes = model.world->scenes();
  model.options = options;
  ASSIGN_OR_RETURN(MotionModel motion,
                   makeMotionModel(world.robot(), world.startPositionIndices()));
  model.motion = std::move(motion);
  model.kernels = motionKernels();
  model.tables = motionTables(model.motion);
  ASSIGN_OR_RETURN(const sensors::LaserSettings laser,
                   sensors::laserSettings(options.sensors.laser, world.robot(), model.motion));
  layOutObservation(laser.size(), model);
  measure(world, model);
  model.groups = spheresByEights(model.motion.ranges);
  model.slices = FreeSlices(model.groups);
  model.clearance = ClearanceMaps(radiiOfLanes(model));
  StartFinder finder(model);
  finder.find();
  if (model.starts.empty()) {
    return fail(ErrorCode::kInvalidInput, "episodes " + std::string(world.episodes().name()),
                "the robot penetrates the scene or an object at the start of all " +
                    std::to_string(model.skipped.size()) +
                    " episodes; check that scene, robot and episodes belong together",
                kNoEpisodeStarts);
  }
  mapFloors(finder.heights(), model);
  RETURN_IF_ERROR(makeSensors(laser, model));
  return model;
}

}  // namespace galactic::simulation
