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

}  // namespace

Chunk::Chunk(const Model& model)
    : action_count_(model.actionCount()),
      sphere_count_(model.sphereCount()),
      group_stride_(paddedToLanes(model.sphereCount() / kLanes)),
      body_count_(model.bodyCount()),
      ranges_(model.motion.ranges),
      actions_(kChunk * model.actionCount()),
      variables_(kChunk * model.variableCount()),
      centers_(kChunk * 3 * model.sphereCount()),
      bounds_(kChunk * kBounds * group_stride_ / kLanes),
      bodies_(kChunk * body_count_),
      frames_(frameScratchSize(model.motion.nodes.size()) / kMostWidth),
      collision_(std::max(model.sphereCount(), model.most_held_spheres)),
      placement_(model.most_held_spheres, model.world->radii()),
      group_bits_(group_stride_ / kLanes),
      places_(model.groups.size()),
      way_out_(mostWays(model)),
      column_ways_(kLanes * mostWays(model)),
      blocked_bits_(model.bodyWords()),
      held_bits_(model.heldWords()),
      body_bits_(model.bodyWords()) {}

PoseArrays Chunk::candidates(std::size_t first) {
  return {.x = x_.data() + first,
          .y = y_.data() + first,
          .z = z_.data() + first,
          .yaw = yaw_.data() + first,
          .variables = variables_.data() + first,
          .stride = kChunk};
}

BodyArrays Chunk::bodies(std::size_t first) {
  static_assert(sizeof(RigidTransform) == 12 * sizeof(float));
  return {.centers = centers_.data() + first * 3 * sphere_count_,
          .grips = grips_[first].data(),
          .bodies = body_count_ == 0
                        ? nullptr
                        : reinterpret_cast<float*>(bodies_.data() + first * body_count_),
          .bounds = bounds_.data()->values.data() + first * kBounds * group_stride_,
          .extents = extents_[first].values.data()};
}

void Chunk::shift(std::size_t env, const Vec3& by) {
  x_[env] += by.x;
  y_[env] += by.y;
  z_[env] += by.z;
  float* row = centers_.data() + env * 3 * sphere_count_;
  const auto add = [count = sphere_count_](float* to, float by_this) {
    // Most floors are flat.
    if (by_this == 0) return;
    for (std::size_t n = 0; n < count; n += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) to[n + lane] += by_this;
    }
  };
  add(row, by.x);
  add(row + sphere_count_, by.y);
  add(row + 2 * sphere_count_, by.z);
  shiftBounds(env, by);
  GripFrame& grip = grips_[env];
  grip[9] += by.x;
  grip[10] += by.y;
  grip[11] += by.z;
  for (RigidTransform& body : bodyTransforms(env)) body.origin = body.origin + by;
}

void Chunk::takeOver(std::size_t env, Chunk& other, std::size_t from) {
  x_[env] = other.x_[from];
  y_[env] = other.y_[from];
  z_[env] = other.z_[from];
  yaw_[env] = other.yaw_[from];
  for (std::size_t v = 0; v < variables_.size(); v += kChunk) {
    variables_[v + env] = other.variables_[v + from];
  }
  const auto takeRow = [&](auto& mine, const auto& theirs, std::size_t length) {
    std::copy_n(theirs.begin() + static_cast<std::ptrdiff_t>(from * length), length,
                mine.begin() + static_cast<std::ptrdiff_t>(env * length));
  };
  takeRow(centers_, other.centers_, 3 * sphere_count_);
  takeRow(bounds_, other.bounds_, kBounds * group_stride_ / kLanes);
  takeRow(bodies_, other.bodies_, body_count_);
  extents_[env] = other.extents_[from];
  grips_[env] = other.grips_[from];
  floor_[env] = other.floor_[from];
}

void Chunk::shiftBounds(std::size_t env, const Vec3& by) {
  // Rounding keeps order: the bounds of what has moved are the bounds moved.
  const std::array<float, kLanes> each{by.x, by.x, by.y, by.y, by.z, by.z, 0, 0};
  for (std::size_t b = 0; b < kLanes; ++b) extents_[env].values[b] += each[b];
  AlignedLanes* lanes = bounds_.data() + env * kBounds * group_stride_ / kLanes;
  for (std::size_t b = 0; b < kBounds; ++b) {
    const float by_this = each[b];
    for (std::size_t n = 0; n < group_stride_; n += kLanes, ++lanes) {
      for (float& value : lanes->values) value += by_this;
    }
  }
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
  const float* row = centers_.data() + env * 3 * sphere_count_;
  return {row, row + sphere_count_, row + 2 * sphere_count_, ranges_};
}

}  // namespace galactic::simulation
