#include "simulation/phases/chunk.h"

#include <algorithm>

namespace galactic::simulation {
namespace {

/// How often each sphere may be added to a way out: once per attempt of the default rule.
constexpr std::size_t kWaysOut = 3;

/// The most eights of spheres that a way out may have. Groups are added whole; spheres outside the
/// slices one by one.
std::size_t mostWays(const Model& model) {
  return kWaysOut * (2 * model.groups.size() + model.most_held_spheres / kLanes + 1);
}

/// Moves one env's point, whose coordinates are in three rows.
void moveBy(EnvRow* rows, std::size_t env, const Vec3& by) {
  rows[0].values[env] += by.x;
  rows[1].values[env] += by.y;
  rows[2].values[env] += by.z;
}

}  // namespace

SceneExitScratch::SceneExitScratch(const Model& model)
    : way(mostWays(model)),
      columns(kLanes * mostWays(model)),
      suited(paddedToLanes(model.groups.size()) / kLanes),
      in_columns(suited.size()) {}

Chunk::Chunk(const Model& model)
    : kernels_(model.kernels),
      sphere_count_(model.sphereCount()),
      group_count_(model.groups.size()),
      group_stride_(paddedToLanes(model.sphereCount() / kLanes)),
      wants_bodies_(model.bodyCount() != 0),
      ranges_(model.motion.ranges),
      actions_(model.actionCount()),
      arrived_(model.options.noise.delaysActions() ? model.actionCount() : 0),
      motions_(model.options.noise.changesMotion() ? model.actionLayout().movingCount() : 0),
      given_actions_(kChunk * model.actionCount()),
      rows_(kBaseRows + model.variableCount() + kGripNumbers),
      centers_(kChunk * 3 * model.sphereCount() / kLanes),
      bounds_(kChunk * kBounds * group_stride_ / kLanes),
      group_radii_(group_stride_ / kLanes),
      frames_(frameRows(model.motion.nodes.size())),
      collision_(std::max(model.sphereCount(), model.most_held_spheres)),
      placement_(model.most_held_spheres, model.world->radii()),
      sure_(group_stride_ / kLanes * kChunk),
      in_slices_(sure_.size()),
      seen_(group_stride_ / kLanes),
      places_(kChunk * model.groups.size()),
      scene_exit_(model),
      held_bits_(model.heldWords()),
      body_bits_(model.bodyWords()) {
  for (std::size_t n = 0; n < group_count_; ++n) {
    group_radii_[n / kLanes].values[n % kLanes] = model.groups[n].radius;
  }
}

BodyArrays Chunk::bodies(std::size_t first) {
  shiftFrames();
  return {.frames = frames_.front().values + first,
          .centers = centers_.data()->values.data() + first * spheresStride(),
          .grips = (&rows_.back() + 1 - kGripNumbers)->values + first,
          .bounds = bounds_.data()->values.data() + first * kBounds * group_stride_,
          .extents = extents_[first].values};
}

void Chunk::shift(std::size_t env, const Vec3& by) {
  moveBy(rows_.data(), env, by);
  kernels_.shift({.by_x = by.x,
                  .by_y = by.y,
                  .by_z = by.z,
                  .centers = centers_.data()->values.data() + env * spheresStride(),
                  .sphere_count = sphere_count_,
                  .bounds = bounds_.data()->values.data() + env * kBounds * group_stride_,
                  .group_count = group_stride_,
                  .extents = extents_[env].values});
  moveBy(&rows_.back() + 1 - kGripNumbers + 9, env, by);
  if (!wants_bodies_) return;
  // Frames follow later, those of all candidates at once; each may lag by one move only.
  const std::uint32_t bit = std::uint32_t{1} << env;
  if ((are_behind_ & bit) != 0) shiftFrames();
  are_behind_ |= bit;
  frames_behind_[0].values[env] = by.x;
  frames_behind_[1].values[env] = by.y;
  frames_behind_[2].values[env] = by.z;
}

void Chunk::shiftFrames() {
  static_assert(kChunk <= 32);
  if (are_behind_ == 0) return;
  kernels_.shift_frames({.frames = frames_.front().values,
                         .rows = frames_.size(),
                         .by = frames_behind_.front().values,
                         .envs = kChunk});
  frames_behind_ = {};
  are_behind_ = 0;
}

void Chunk::takeOver(std::size_t env, Chunk& other, std::size_t from) {
  shiftFrames();
  other.shiftFrames();
  const auto take_lane = [&](std::vector<EnvRow>& mine, const std::vector<EnvRow>& theirs) {
    for (std::size_t n = 0; n < mine.size(); ++n) mine[n].values[env] = theirs[n].values[from];
  };
  take_lane(rows_, other.rows_);
  if (wants_bodies_) take_lane(frames_, other.frames_);
  const auto take_row = [&](auto& mine, const auto& theirs, std::size_t length) {
    std::copy_n(theirs.begin() + static_cast<std::ptrdiff_t>(from * length), length,
                mine.begin() + static_cast<std::ptrdiff_t>(env * length));
  };
  take_row(centers_, other.centers_, spheresStride() / kLanes);
  take_row(bounds_, other.bounds_, kBounds * group_stride_ / kLanes);
  extents_[env] = other.extents_[from];
  floor_[env] = other.floor_[from];
}

SphereBatch Chunk::spheres(std::size_t env) const {
  const float* row = centers_.data()->values.data() + env * spheresStride();
  return {row, row + sphere_count_, row + 2 * sphere_count_, ranges_};
}

BoundedSpheres Chunk::boundedSpheres(std::size_t env) const {
  const SphereBatch all = spheres(env);
  return {.x = all.x,
          .y = all.y,
          .z = all.z,
          .group_count = group_count_,
          .radii = group_radii_.data()->values.data(),
          .bounds = bounds(env, 0).values,
          .bounds_stride = group_stride_,
          .all = &extents_[env]};
}

}  // namespace galactic::simulation
