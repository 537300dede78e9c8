#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "simulation/collision/clearance_map.h"
#include "simulation/collision/collision.h"
#include "simulation/collision/floor_query.h"
#include "simulation/phases/object_placement.h"
#include "simulation/state/batch_state.h"
#include "simulation/state/model.h"
#include "simulation/ways_out/column_ways.h"
#include "simulation/ways_out/free_slices.h"
#include "simulation/ways_out/way_out.h"

namespace galactic::simulation {

/// The result of a query about eight groups of eight spheres of one candidate; groups as bits.
struct SeenGroups {
  /// Groups that the maps do not know to be entirely free.
  unsigned unsure = 0;
  /// Spheres that the scene blocks, as bits.
  std::uint64_t blocked = 0;
};

/// The result of a query about the object that one candidate holds.
struct SeenHeld {
  /// Bounds of the centers of its spheres, with a small margin.
  CenterBounds bounds;
  /// Whether the maps know that the scene blocks none of them.
  bool clears_scene = false;
};

/// Scratch space of a search for the way out of the scene.
struct SceneExitScratch {
  explicit SceneExitScratch(const Model& model);

  WayOut way;
  ColumnWays columns;
  /// The robot's groups, eight by eight, as bits: those all of whose spheres were added to the way,
  /// so that they are free where it leads.
  std::vector<unsigned> suited;
  /// Groups whose spheres were added to the columns.
  std::vector<unsigned> in_columns;
};

/// Scratch space for kChunk envs during a step, allocated once per thread.
class Chunk {
 public:
  explicit Chunk(const Model& model);

  /// Actions of the chunk's envs, each in [-1, 1]. Shape: actions.
  [[nodiscard]] std::span<EnvRow> actions() { return actions_; }
  [[nodiscard]] float& action(std::size_t n, std::size_t env) { return actions_[n].values[env]; }
  /// Space for the actions that arrive in this step. Empty unless actions are delayed.
  [[nodiscard]] std::span<EnvRow> arrived() { return arrived_; }
  /// Space for the motions that the robots make of their actions: joints, forward, turn. Empty if
  /// they move exactly as asked.
  [[nodiscard]] std::span<EnvRow> motions() { return motions_; }
  /// Space for the actions of the chunk as a caller passes them.
  [[nodiscard]] std::span<float> givenActions() { return given_actions_; }
  /// Candidate poses of the chunk's envs from `first` on.
  [[nodiscard]] PoseArrays candidates(std::size_t first) {
    return posesAt(rows_.front().values + first);
  }
  /// The rows of the candidates: base, variables and grip.
  [[nodiscard]] std::span<const EnvRow> poseRows() const { return rows_; }
  [[nodiscard]] BodyArrays bodies(std::size_t first);
  [[nodiscard]] Vec3 base(std::size_t env) const {
    return {rows_[0].values[env], rows_[1].values[env], rows_[2].values[env]};
  }
  /// Moves a candidate with all its spheres and its grip.
  void shift(std::size_t env, const Vec3& by);
  /// Copies the candidate of another chunk's env, with its spheres, grip and bodies.
  void takeOver(std::size_t env, Chunk& other, std::size_t from);
  [[nodiscard]] SphereBatch spheres(std::size_t env) const;
  /// Bounds of the candidate's sphere centers, eight by eight, from group 8 * `eight` on.
  [[nodiscard]] GroupBounds bounds(std::size_t env, std::size_t eight) const {
    return {bounds_.data()->values.data() + env * kBounds * group_stride_ + eight * kLanes,
            group_stride_};
  }
  /// Floats from the spheres of one env to those of the next.
  [[nodiscard]] std::size_t spheresStride() const { return 3 * sphere_count_; }
  /// Floats from the bounds of one env to those of the next.
  [[nodiscard]] std::size_t boundsStride() const { return kBounds * group_stride_; }
  /// The maps' last answers about the groups from 8 * `eight` on, env by env.
  [[nodiscard]] std::span<SureGroups> sure(std::size_t eight) {
    return std::span(sure_).subspan(eight * kChunk, kChunk);
  }
  /// The slices' answers about those of these groups that are not surely free, from the last
  /// lookAtAll().
  [[nodiscard]] std::span<InSlices> inSlices(std::size_t eight) {
    return std::span(in_slices_).subspan(eight * kChunk, kChunk);
  }
  /// Bounds of all sphere centers of the candidate.
  [[nodiscard]] const CenterBounds& extents(std::size_t env) const { return extents_[env]; }
  /// The lowest and the highest height of a center.
  [[nodiscard]] float lowest(std::size_t env) const { return extents_[env].values[2]; }
  [[nodiscard]] float highest(std::size_t env) const { return extents_[env].values[3]; }
  [[nodiscard]] BoundedSpheres boundedSpheres(std::size_t env) const;
  [[nodiscard]] GripFrame grip(std::size_t env) const {
    GripFrame grip{};
    const EnvRow* rows = gripRows();
    for (std::size_t k = 0; k < kGripNumbers; ++k) grip[k] = rows[k].values[env];
    return grip;
  }
  /// Root and nodes of the candidates. Shape: frameRows of the nodes.
  [[nodiscard]] std::span<const EnvRow> frames() {
    shiftFrames();
    return frames_;
  }
  [[nodiscard]] Floor& floor(std::size_t env) { return floor_[env]; }
  [[nodiscard]] CollisionScratch& collision() { return collision_; }
  [[nodiscard]] PlacementScratch& placement() { return placement_; }
  /// What the last search for blocked spheres found among the groups from 8 * `eight` on.
  [[nodiscard]] SeenGroups& seen(std::size_t eight) { return seen_[eight]; }
  /// The places of the spheres of those groups from 8 * `eight` on that slices were asked about.
  [[nodiscard]] EightPlaces* places(std::size_t env, std::size_t eight) {
    return places_.data() + env * group_count_ + eight * kLanes;
  }
  /// EightPlaces from those of one env to those of the next.
  [[nodiscard]] std::size_t placesStride() const { return group_count_; }
  /// Scratch space of a search for the way out of the scene.
  [[nodiscard]] SceneExitScratch& sceneExit() { return scene_exit_; }
  /// What the last query about the held object found.
  [[nodiscard]] SeenHeld& seenHeld(std::size_t env) { return seen_held_[env]; }
  /// One bit for each sphere of the held object that penetrates something, whether it counts or
  /// not. Valid once the candidate was found free.
  [[nodiscard]] std::span<std::uint64_t> heldBits() { return held_bits_; }
  /// Space for one bit per sphere of the robot.
  [[nodiscard]] std::span<std::uint64_t> bodyBits() { return body_bits_; }

 private:
  /// Catches up the frames with the candidates that shift() has moved.
  void shiftFrames();
  [[nodiscard]] const EnvRow* gripRows() const { return &rows_.back() + 1 - kGripNumbers; }

  struct alignas(32) AlignedLanes {
    std::array<float, kLanes> values{};
  };

  MotionKernels kernels_;
  std::size_t sphere_count_ = 0;
  std::size_t group_count_ = 0;
  /// Groups of eight spheres, padded to lanes.
  std::size_t group_stride_ = 0;
  bool wants_bodies_ = false;
  std::span<const RadiusRange> ranges_;
  std::vector<EnvRow> actions_;
  std::vector<EnvRow> arrived_;
  std::vector<EnvRow> motions_;
  std::vector<float> given_actions_;
  /// Laid out like the first rows of a BatchState.
  std::vector<EnvRow> rows_;
  std::vector<AlignedLanes> centers_;
  std::vector<AlignedLanes> bounds_;
  std::array<CenterBounds, kChunk> extents_{};
  /// Radii of the groups, meters, padded to lanes.
  std::vector<AlignedLanes> group_radii_;
  std::vector<EnvRow> frames_;
  /// How far the frames lag behind their candidates, along X, Y and Z, and which ones lag, as bits.
  std::array<EnvRow, 3> frames_behind_{};
  std::uint32_t are_behind_ = 0;
  std::array<Floor, kChunk> floor_{};
  CollisionScratch collision_;
  PlacementScratch placement_;
  /// Shape: eights of groups x kChunk.
  std::vector<SureGroups> sure_;
  std::vector<InSlices> in_slices_;
  std::vector<SeenGroups> seen_;
  std::vector<EightPlaces> places_;
  SceneExitScratch scene_exit_;
  std::array<SeenHeld, kChunk> seen_held_{};
  std::vector<std::uint64_t> held_bits_;
  std::vector<std::uint64_t> body_bits_;
};

/// The envs [first, first + kChunk) of a batch in one step.
struct ChunkStep {
  const Model& model;
  BatchState& state;
  Chunk& chunk;
  std::size_t first = 0;
  /// Scratch space for places on the way of one env; null if only the ends of moves are checked.
  Chunk* between = nullptr;
};

}  // namespace galactic::simulation
