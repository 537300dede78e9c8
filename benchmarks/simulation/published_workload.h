#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/simulation_options.h"

namespace galactic::published_workload {

/// What robots do: random actions; the same, but always ahead; the same with the target in the
/// hand.
enum class Load : std::int64_t { kRandom = 0, kForward = 1, kHeld = 2 };

inline constexpr std::uint32_t kEpisodeSteps = 500;
inline constexpr std::size_t kBatches = 512;

/// The workload's actions: one of 512 batches of uniform numbers that only (step, env, action)
/// decide.
class Actions {
 public:
  /// `steps`: no more will be taken.
  Actions(std::size_t envs, std::size_t count, Load load, std::size_t steps = kBatches)
      : size_(envs * count), count_(count), load_(load) {
    const std::size_t batches = std::min(steps, kBatches);
    values_.resize(batches * size_);
    for (std::size_t step = 0; step < batches; ++step) {
      for (std::size_t env = 0; env < envs; ++env) {
        fillRow(std::span(values_).subspan(step * size_ + env * count, count), step, env, load);
      }
    }
  }

  /// `begin`: the envs whose episode begins with this step; their robots do not move in it.
  [[nodiscard]] std::span<const float> batch(std::size_t step, std::span<const std::size_t> begin) {
    for (const std::size_t env : begin_) fillRow(row(step_, env), step_ % kBatches, env, load_);
    step_ = step;
    begin_ = begin;
    for (const std::size_t env : begin_) {
      const std::span<float> first = row(step, env);
      std::fill(first.begin(), first.end(), 0.0F);
      if (load_ == Load::kHeld) first[count_ - 2] = 1;
    }
    return std::span(values_).subspan(step % kBatches * size_, size_);
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z += 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }

  static float uniform(std::size_t step, std::size_t env, std::size_t action) {
    constexpr std::uint64_t kSeed = 1;
    const std::uint64_t hash = mix(mix(mix(mix(kSeed) ^ step) ^ env) ^ action);
    return static_cast<float>(hash >> 40U) * 0x1p-23F - 1;
  }

  [[nodiscard]] std::span<float> row(std::size_t step, std::size_t env) {
    return std::span(values_).subspan(step % kBatches * size_ + env * count_, count_);
  }

  /// The published order of actions is hand, turn, forward, joints, stop; its turn is positive
  /// counter-clockwise.
  static void fillRow(std::span<float> row, std::size_t step, std::size_t env, Load load) {
    const std::size_t joints = row.size() - 4;
    for (std::size_t n = 0; n < joints; ++n) row[n] = uniform(step, env, 3 + n);
    const float forward = uniform(step, env, 2);
    row[joints] = load == Load::kForward ? 0.5F + 0.5F * forward : forward;
    row[joints + 1] = -uniform(step, env, 1);
    row[joints + 2] = load == Load::kHeld ? 1.0F : uniform(step, env, 0);
    row[joints + 3] = 0;
  }

  std::size_t size_;
  std::size_t count_;
  Load load_;
  std::vector<float> values_;
  /// Of the batch given last.
  std::size_t step_ = 0;
  std::span<const std::size_t> begin_;
};

/// Which env begins which episode when: each every 500 steps, evenly spread.
class Resets {
 public:
  Resets(std::size_t envs, std::size_t episodes) : by_phase_(kEpisodeSteps), resets_(envs, -1) {
    for (std::size_t env = 0; env < envs; ++env) {
      const std::size_t offset = env * kEpisodeSteps / envs;
      by_phase_[(kEpisodeSteps - offset) % kEpisodeSteps].push_back(env);
      next_.push_back((env + 1) % episodes);
    }
    episodes_ = episodes;
  }

  [[nodiscard]] std::span<const std::int32_t> at(std::size_t step) {
    for (const std::size_t env : last_) resets_[env] = -1;
    last_ = {};
    if (step > 0) last_ = by_phase_[step % kEpisodeSteps];
    for (const std::size_t env : last_) {
      resets_[env] = static_cast<std::int32_t>(next_[env]);
      next_[env] = (next_[env] + 1) % episodes_;
    }
    return resets_;
  }

  /// The envs that the last call reset.
  [[nodiscard]] std::span<const std::size_t> last() const { return last_; }

 private:
  std::vector<std::vector<std::size_t>> by_phase_;
  std::vector<std::size_t> next_;
  std::vector<std::int32_t> resets_;
  std::span<const std::size_t> last_;
  std::size_t episodes_ = 1;
};

/// `published_slide`: with the workload's own slide rule, five pushes of 5 cm towards the base.
inline SimulationOptions optionsOf(std::uint32_t envs, bool published_slide) {
  SimulationOptions options;
  options.envs = envs;
  options.threads = 1;
  options.order = EpisodeOrder::kLinear;
  options.body_transforms = true;
  options.action.release = -0.5F;
  options.task.kind = TaskKind::kNone;
  options.task.most_steps = 0;
  if (published_slide) {
    options.slide = {.attempts = 5, .direction = SlideDirection::kTowardsBase, .step = 0.05F};
  }
  return options;
}

}  // namespace galactic::published_workload
