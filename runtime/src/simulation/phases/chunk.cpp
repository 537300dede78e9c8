#include "simulation/phases/chunk.h"

#include <algorithm>

namespace galactic::simulation {
namespace {

/// How often each sphere may be added to a way out: once with each attempt of the default rule.
constexpr std::size_t kWaysOut = 3;

/// Eights of spheres that a way out may have at most. Groups come whole, and spheres that no slice
/// knows one by one.
std::size_t mostWays(const Model& model) {
  return kWaysOut * (2 * model.groups.size() + model.most_held_spheres / kLanes + 1);
}

/// A point, whose coordinates are these rows.
void moveBy(EnvRow* rows, std::size_t env, const Vec3& by) {
  rows[0].values[env] += by.x;
  rows[1].values[env] += by.y;
  rows[2].values[env] += by.z;
}

}  // namespace

Chunk::Chunk(const Model& model)
    : sphere_count_(model.sphereCount()),
      group_stride_(paddedToLanes(model.sphereCount() / kLanes)),
      wants_bodies_(model.bodyCount() != 0),
      ranges_(model.motion.ranges),
      actions_(model.actionCount()),
      given_actions_(kChunk * model.actionCount()),
      rows_(kBaseRows + model.variableCount() + kGripNumbers),
      centers_(kChunk * 3 * model.sphereCount() / kLanes),
      bounds_(kChunk * kBounds * group_stride_ / kLanes),
      frames_(frameRows(model.motion.nodes.size())),
      collision_(std::max(model.sphereCount(), model.most_held_spheres)),
      placement_(model.most_held_spheres, model.world->radii()),
      sure_(group_stride_ / kLanes * kChunk),
      group_bits_(group_stride_ / kLanes),
      places_(model.groups.size()),
      way_out_(mostWays(model)),
      column_ways_(kLanes * mostWays(model)),
      blocked_bits_(model.bodyWords()),
      held_bits_(model.heldWords()),
      body_bits_(model.bodyWords()) {}

BodyArrays Chunk::bodies(std::size_t first) {
  return {.frames = frames_.front().values + first,
          .centers = centers_.data()->values.data() + first * 3 * sphere_count_,
          .grips = (&rows_.back() + 1 - kGripNumbers)->values + first,
          .bounds = bounds_.data()->values.data() + first * kBounds * group_stride_,
          .extents = extents_[first].values.data()};
}

void Chunk::shift(std::size_t env, const Vec3& by) {
  moveBy(rows_.data(), env, by);
  float* row = centers_.data()->values.data() + env * 3 * sphere_count_;
  const auto add = [count = sphere_count_](float* to, float by_this) {
    for (std::size_t n = 0; n < count; n += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) to[n + lane] += by_this;
    }
  };
  add(row, by.x);
  // Most floors are flat.
  if (by.y != 0) add(row + sphere_count_, by.y);
  add(row + 2 * sphere_count_, by.z);
  shiftBounds(env, by);
  moveBy(&rows_.back() + 1 - kGripNumbers + 9, env, by);
  constexpr std::size_t kOrigin = 9;
  for (std::size_t n = kOrigin; wants_bodies_ && n < frames_.size(); n += kFrameNumbers) {
    moveBy(frames_.data() + n, env, by);
  }
}

void Chunk::takeOver(std::size_t env, Chunk& other, std::size_t from) {
  const auto takeLane = [&](std::vector<EnvRow>& mine, const std::vector<EnvRow>& theirs) {
    for (std::size_t n = 0; n < mine.size(); ++n) mine[n].values[env] = theirs[n].values[from];
  };
  takeLane(rows_, other.rows_);
  if (wants_bodies_) takeLane(frames_, other.frames_);
  const auto takeRow = [&](auto& mine, const auto& theirs, std::size_t length) {
    std::copy_n(theirs.begin() + static_cast<std::ptrdiff_t>(from * length), length,
                mine.begin() + static_cast<std::ptrdiff_t>(env * length));
  };
  takeRow(centers_, other.centers_, 3 * sphere_count_ / kLanes);
  takeRow(bounds_, other.bounds_, kBounds * group_stride_ / kLanes);
  extents_[env] = other.extents_[from];
  floor_[env] = other.floor_[from];
}

void Chunk::shiftBounds(std::size_t env, const Vec3& by) {
  // Rounding keeps order: the bounds of what has moved are the bounds moved.
  AlignedLanes* lanes = bounds_.data() + env * kBounds * group_stride_ / kLanes;
  const auto add = [&](std::size_t bound, float by_this) {
    extents_[env].values[bound] += by_this;
    for (std::size_t n = 0; n < group_stride_; n += kLanes, ++lanes) {
      for (float& value : lanes->values) value += by_this;
    }
  };
  add(0, by.x);
  add(1, by.x);
  add(2, by.y);
  add(3, by.y);
  add(4, by.z);
  add(5, by.z);
}

Vec3 Chunk::least(std::size_t env) const {
  const std::array<float, kLanes>& bounds = extents_[env].values;
  return {bounds[0], bounds[2], bounds[4]};
}

Vec3 Chunk::most(std::size_t env) const {
  const std::array<float, kLanes>& bounds = extents_[env].values;
  return {bounds[1], bounds[3], bounds[5]};
}

SphereBatch Chunk::spheres(std::size_t env) const {
  const float* row = centers_.data()->values.data() + env * 3 * sphere_count_;
  return {row, row + sphere_count_, row + 2 * sphere_count_, ranges_};
}

}  // namespace galactic::simulation
