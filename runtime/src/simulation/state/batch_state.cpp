#include "simulation/state/batch_state.h"

#include <algorithm>
#include <cmath>

#include "support/huge_pages.h"

namespace galactic::simulation {
namespace {

std::size_t odometryRows(const Model& model) { return model.hasOdometry() ? kOdometryRows : 0; }

/// Rows of a chunk: its robots, three points, the joint actions of the previous step, and odometry.
std::size_t rowCount(const Model& model) {
  return kBaseRows + model.variableCount() + kGripNumbers + std::size_t{3} * 3 +
         model.motion.controlled.size() + odometryRows(model);
}

/// Bytes of one env in all vectors, so that a batch can allocate its memory in one piece.
std::size_t envBytes(const Model& model) {
  // The most that the alignment of an env's own vectors may cost.
  constexpr std::size_t kPadding = 96;
  // Done, success, ending, pick and idle, beside the reward.
  constexpr std::size_t kOutcomeBytes = 5;
  const std::size_t kept = model.keptSteps() * model.actionCount();
  const std::size_t floats = rowCount(model) + kept + 2 * model.observation_size + 1;
  return kPadding + sizeof(Env) + sizeof(EnvCounters) + sizeof(MoveCounters) + sizeof(Held) +
         sizeof(RestingObjects) + model.most_objects * (sizeof(RestingBox) + sizeof(Pose)) +
         (model.heldWords() + model.most_objects * model.bodyWords()) * sizeof(std::uint64_t) +
         floats * sizeof(float) + kOutcomeBytes + model.bodyCount() * sizeof(RigidTransform);
}

std::size_t boundsBytes(const Model& model) {
  return packsFor(model.most_objects) * sizeof(PackedBounds);
}

template <class T>
std::size_t bytesOf(const std::pmr::vector<T>& values) {
  return values.size() * sizeof(T);
}

std::size_t paddedToChunks(std::size_t count) { return (count + kChunk - 1) / kChunk * kChunk; }

/// Prefetches into the second-level cache: the first does not hold more than a chunk.
void prefetchBytes(const void* first, std::size_t bytes) noexcept {
  constexpr std::size_t kCacheLine = 64;
  const auto* at = static_cast<const char*>(first);
  for (std::size_t n = 0; n < bytes; n += kCacheLine) __builtin_prefetch(at + n, 0, 2);
  // GCC considers a function that only prefetches to have no effect, and drops calls to it.
  asm volatile("");
}

template <class Value>
void prefetchRow(std::span<const Value> row) noexcept {
  prefetchBytes(row.data(), row.size_bytes());
}

}  // namespace

void restObject(const Model& model, BatchState& state, std::size_t n, std::uint32_t object,
                const Pose& world_from_object) noexcept {
  state.setObjectPose(n, object, world_from_object);
  RestingObjects& resting = state.resting(n);
  if (resting.isResting(object)) resting.remove(object);
  const OrientedBox& box = model.object(state.env(n).start, object).box;
  resting.insert(object, restingBox(box, world_from_object));
}

void restObjects(const Model& model, BatchState& state, std::size_t n, std::span<const Pose> poses,
                 std::int32_t held) noexcept {
  const std::span<const Pose> objects = state.objects(n);
  for (std::uint32_t object = 0; object < state.env(n).objects; ++object) {
    const bool is_held = held == static_cast<std::int32_t>(object);
    if (is_held || objects[object] == poses[object]) continue;
    restObject(model, state, n, object, poses[object]);
  }
}

void measureHeld(const ObjectModel& object, Held& held) noexcept {
  if (object.spheres.empty()) return;
  Vec3 least = object.spheres.front().center;
  Vec3 most = least;
  for (const SetSphere& sphere : object.spheres) {
    const Vec3& at = sphere.center;
    least = {std::min(least.x, at.x), std::min(least.y, at.y), std::min(least.z, at.z)};
    most = {std::max(most.x, at.x), std::max(most.y, at.y), std::max(most.z, at.z)};
  }
  const Vec3 center = (least + most) * 0.5F;
  float squared = 0;
  held.radii = 0;
  for (const SetSphere& sphere : object.spheres) {
    const Vec3 away = sphere.center - center;
    squared = std::max(squared, dot(away, away));
    held.radii |= 1U << sphere.radius_index;
  }
  held.ball_center = held.grip_from_object * center;
  held.ball_radius = std::sqrt(squared);
}

std::size_t stateBytes(const Model& model, std::size_t envs) {
  return paddedToChunks(envs) * (envBytes(model) + boundsBytes(model));
}

BatchState::BatchState(const Model& model, std::size_t envs)
    : memory_(paddedToChunks(envs) * envBytes(model), detail::hugePages()),
      bounds_memory_(paddedToChunks(envs) * boundsBytes(model), detail::hugePages()),
      env_count_(envs),
      most_objects_(model.most_objects),
      held_words_(model.heldWords()),
      body_words_(model.bodyWords()),
      variable_count_(model.variableCount()),
      row_count_(rowCount(model)),
      action_count_(model.actionCount()),
      kept_steps_(model.keptSteps()),
      observation_size_(model.observation_size),
      body_count_(model.bodyCount()) {
  const std::size_t padded = paddedToChunks(env_count_);
  envs_.resize(padded);
  counters_.resize(padded);
  moves_.resize(padded);
  held_.resize(padded);
  resting_.reserve(padded);
  for (std::size_t n = 0; n < padded; ++n) {
    // The largest radius in any query: that of a sphere or of the hand.
    const float reach = std::max(model.world->radii().back(), model.motion.grasp_radius);
    resting_.emplace_back(model.most_objects, reach, &memory_, &bounds_memory_);
  }
  objects_.resize(padded * most_objects_);
  ignored_.resize(padded * held_words_);
  leaving_.resize(padded * most_objects_ * body_words_);
  rows_.resize(padded / kChunk * row_count_);
  kept_actions_.resize(padded / kChunk * kept_steps_ * action_count_);
  observations_.resize(padded * observation_size_);
  final_observations_.resize(padded * observation_size_);
  bodies_.resize(padded * body_count_);
  rewards_.resize(padded);
  dones_.resize(padded);
  successes_.resize(padded);
  endings_.resize(padded);
  picks_.resize(padded);
  idle_.resize(padded);
  // If a step reads less than this, waiting for the data costs a core less than prefetching it.
  constexpr std::size_t kNear = std::size_t{1} << 20U;
  const std::size_t read = sizeof(Env) + sizeof(RestingView) + row_count_ * sizeof(float) +
                           observation_size_ * sizeof(float) + body_count_ * sizeof(RigidTransform);
  asks_ahead_ = padded * read > kNear;
}

void BatchState::prefetch(std::size_t n) const noexcept {
  if (n >= envs_.size() || !asks_ahead_) return;
  prefetchBytes(&envs_[n], sizeof(Env));
  prefetchRow(observation(n));
  prefetchRow(bodyTransforms(n));
  // Each env prefetches an equal part of the chunk's rows.
  const std::size_t part = row_count_ * sizeof(float);
  prefetchBytes(reinterpret_cast<const std::byte*>(rows_.data()) + n * part, part);
  prefetchBytes(&resting_[n], sizeof(RestingView));
}

void BatchState::prefetchChunk(std::size_t first) const noexcept {
  if (first >= envs_.size() || !asks_ahead_) return;
  const auto row = [&](const auto& values) {
    prefetchRow(std::span(values).subspan(first, kChunk));
  };
  row(moves_);
  row(rewards_);
  row(dones_);
  row(successes_);
  row(endings_);
  row(picks_);
  row(idle_);
}

void BatchState::prefetchBounds(std::size_t first) const noexcept {
  if (!asks_ahead_) return;
  for (std::size_t n = first; n < first + kChunk; ++n) {
    const RestingView& objects = resting_[n].view();
    prefetchBytes(objects.bounds, objects.bounds_count * sizeof(PackedBounds));
  }
}

std::size_t BatchState::bytes() const {
  std::size_t bytes = bytesOf(envs_) + bytesOf(counters_) + bytesOf(moves_) + bytesOf(held_) +
                      bytesOf(resting_) + bytesOf(objects_) + bytesOf(ignored_) +
                      bytesOf(leaving_) + bytesOf(rows_) + bytesOf(kept_actions_) +
                      2 * bytesOf(observations_) + bytesOf(bodies_) + bytesOf(rewards_) +
                      5 * bytesOf(dones_);
  for (const RestingObjects& resting : resting_) bytes += resting.bytes();
  return bytes;
}

}  // namespace galactic::simulation
