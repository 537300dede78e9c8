#include "galactic/learned_policy.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "galactic/schema/pack_generated.h"
#include "pack/schema_values.h"
#include "policy/action_sampler.h"
#include "policy/aligned_floats.h"
#include "policy/layer_shapes.h"
#include "policy/operation.h"
#include "support/call_check.h"
#include "support/threads/workers.h"
#include "support/try.h"

namespace galactic {
namespace {

using policy::AlignedFloats;
using policy::ObservationRange;
using policy::OperationList;
using policy::Tile;

/// Bytes of values that a thread works on at a time, and the fewest and most envs that they may be
/// for: enough for weights to be read once for many envs.
constexpr std::size_t kTileBytes = std::size_t{1} << 20U;
constexpr std::size_t kFewestEnvs = 12;
constexpr std::size_t kMostEnvs = policy::kRows;

tl::unexpected<Error> unfit(const PackFile& pack, std::string message) {
  return fail(ErrorCode::kInvalidInput, pack.where(), std::move(message));
}

/// Finds the parts that the policy reads in the batch's observations.
Result<std::vector<ObservationRange>> findParts(const PackFile& pack, const PolicyInterface& needs,
                                                const PolicyBatch& batch) {
  std::vector<ObservationRange> ranges;
  for (const PolicyPart& part : needs.observation) {
    const auto found = std::ranges::find(batch.observation, part.name, &ObservationPart::name);
    if (found == batch.observation.end()) {
      std::vector<std::string> names;
      for (const ObservationPart& one : batch.observation) names.push_back(one.name);
      return unfit(pack, fmt::format("reads the observation \"{}\", and the simulation has {}; "
                                     "switch it on, or take a policy that was trained without it",
                                     part.name, fmt::join(names, ", ")));
    }
    if (found->size != part.size) {
      return unfit(pack, fmt::format("reads {} numbers of the observation \"{}\", and the "
                                     "simulation has {}; take the options and the robot that it "
                                     "was trained with",
                                     part.size, part.name, found->size));
    }
    ranges.push_back({found->first, found->size});
  }
  return ranges;
}

/// Checks that the batch makes sense by itself.
Result<void> checkBatch(const PolicyBatch& batch) {
  if (batch.envs == 0) {
    return fail(ErrorCode::kInvalidInput, "policy batch", "has no envs, expected at least one");
  }
  const std::size_t size = batch.observation_size;
  for (const ObservationPart& part : batch.observation) {
    if (part.first <= size && part.size <= size - part.first) continue;
    return fail(ErrorCode::kInvalidInput, "policy batch",
                fmt::format("has {} numbers of \"{}\" from number {} of an observation on, "
                            "expected them within its {} numbers",
                            part.size, part.name, part.first, size));
  }
  return {};
}

Result<void> checkActions(const PackFile& pack, const PolicyInterface& needs,
                          const PolicyBatch& batch) {
  if (!needs.robot.empty() && !batch.robot.empty() && needs.robot != batch.robot) {
    return unfit(pack, fmt::format("moves the robot \"{}\", and the world has \"{}\"; take a "
                                   "policy that was trained with this robot",
                                   needs.robot, batch.robot));
  }
  const std::size_t actions = std::size_t{needs.continuous_actions} + needs.discrete_actions;
  if (actions == batch.actions) return {};
  return unfit(pack, fmt::format("decides {} actions, and the robot has {}; take a policy that was "
                                 "trained with this robot",
                                 actions, batch.actions));
}

std::vector<std::vector<float>> discreteValues(const schema::Policy& stored) {
  std::vector<std::vector<float>> values;
  for (const schema::DiscreteAction* action : *stored.discrete()) {
    values.emplace_back(action->values()->begin(), action->values()->end());
  }
  return values;
}

/// The layers that determine actions: means, logarithms of deviations, then logits.
std::vector<std::uint32_t> decidingLayers(const schema::Policy& stored) {
  std::vector<std::uint32_t> layers;
  if (const schema::ContinuousActions* continuous = stored.continuous()) {
    layers = {continuous->mean(), continuous->log_deviation()};
  }
  for (const schema::DiscreteAction* action : *stored.discrete()) {
    layers.push_back(action->logits());
  }
  return layers;
}

std::size_t tileSize(const OperationList& network, std::size_t envs, std::size_t threads) {
  const std::size_t bytes = std::max<std::size_t>(1, network.plan.total()) * sizeof(float);
  const std::size_t size = std::clamp(kTileBytes / bytes, kFewestEnvs, kMostEnvs);
  return std::max<std::size_t>(1, std::min(size, (envs + threads - 1) / threads));
}

}  // namespace

PolicyBatch policyBatchOf(const BatchSimulator& simulator) {
  return {.envs = simulator.envCount(),
          .actions = simulator.actionCount(),
          .observation_size = simulator.observationSize(),
          .observation = simulator.observationParts(),
          .robot = std::string(simulator.world().robot().name())};
}

/// Must not move: its threads refer to it.
class LearnedPolicy::Impl {
 public:
  Impl(const schema::Policy& stored, PolicyInterface needs, OperationList network,
       const PolicyBatch& batch, const LearnedPolicyOptions& options)
      : needs_(std::move(needs)),
        network_(std::move(network)),
        kernels_(policy::kernels()),
        options_(options),
        envs_(batch.envs),
        observation_size_(batch.observation_size),
        action_count_(batch.actions),
        deciding_(decidingLayers(stored)),
        states_(envs_ * network_.state_size),
        previous_(envs_ * action_count_) {
    const std::size_t threads = std::max<std::size_t>(
        1, std::min<std::size_t>(detail::threadCount(options.threads), envs_));
    tile_size_ = tileSize(network_, envs_, threads);
    const policy::ActionSampler sampler(needs_.continuous_actions, discreteValues(stored));
    for (std::size_t n = 0; n < threads; ++n) {
      parts_.push_back({AlignedFloats(network_.plan.total() * tile_size_ + policy::kLane), sampler,
                        std::vector<const float*>(needs_.discrete_actions)});
    }
    if (threads > 1) workers_.emplace(threads, [this](std::size_t part) { actInPart(part); });
  }

  void act(const PolicyInputs& inputs, std::span<float> actions) {
    check(inputs, actions);
    network_inputs_ = {.observations = inputs.observations.data(),
                       .observation_size = observation_size_,
                       .color = inputs.color.data(),
                       .color_bytes = inputs.color.size() / std::max<std::size_t>(1, pixelCount()),
                       .depth = inputs.depth.data(),
                       .previous_actions = previous_.data(),
                       .action_count = action_count_};
    dones_ = inputs.dones;
    actions_ = actions;
    if (workers_) {
      workers_->run();
    } else {
      actInPart(0);
    }
    ++step_;
  }

  void reset() noexcept {
    for (std::size_t env = 0; env < envs_; ++env) resetEnv(env);
    step_ = 0;
  }

  void reset(std::uint32_t first_env) noexcept {
    options_.first_env = first_env;
    reset();
  }

  [[nodiscard]] const PolicyInterface& interface() const { return needs_; }
  [[nodiscard]] std::size_t threadCount() const { return parts_.size(); }
  [[nodiscard]] std::size_t memoryBytes() const {
    std::size_t floats = states_.size() + previous_.size();
    for (const Part& part : parts_) floats += part.arena.size();
    for (const auto& operation : network_.operations) floats += operation->weightCount();
    return floats * sizeof(float);
  }

 private:
  /// What one thread works with.
  struct Part {
    AlignedFloats arena;
    policy::ActionSampler sampler;
    std::vector<const float*> logits;
  };

  /// Pixels in the images of all envs.
  [[nodiscard]] std::size_t pixelCount() const {
    return needs_.image ? std::size_t{needs_.image->width} * needs_.image->height * envs_ : 0;
  }

  void check(const PolicyInputs& inputs, std::span<const float> actions) const {
    const auto check = [](const char* array, std::size_t found, std::size_t expected) {
      detail::checkLength("LearnedPolicy::act", array, found, expected);
    };
    check("actions", actions.size(), envs_ * action_count_);
    check("observations", inputs.observations.size(), envs_ * observation_size_);
    if (!inputs.dones.empty()) check("dones", inputs.dones.size(), envs_);
    if (!needs_.image) return;
    if (needs_.image->depth) check("depth", inputs.depth.size(), pixelCount());
    const std::size_t rgb = pixelCount() * 3;
    if (needs_.image->color && inputs.color.size() != pixelCount() * 4) {
      check("color", inputs.color.size(), rgb);
    }
  }

  void resetEnv(std::size_t env) noexcept {
    std::fill_n(states_.data() + env * network_.state_size, network_.state_size, 0.0F);
    std::fill_n(previous_.begin() + static_cast<std::ptrdiff_t>(env * action_count_), action_count_,
                0.0F);
  }

  /// Handles every n-th tile, where n is the number of parts.
  void actInPart(std::size_t part) noexcept {
    const std::size_t tiles = (envs_ + tile_size_ - 1) / tile_size_;
    for (std::size_t n = part; n < tiles; n += parts_.size()) {
      const std::size_t first = n * tile_size_;
      const Tile tile{.kernels = &kernels_,
                      .plan = &network_.plan,
                      .inputs = &network_inputs_,
                      .arena = parts_[part].arena.data(),
                      .capacity = tile_size_,
                      .first_env = first,
                      .count = std::min(tile_size_, envs_ - first),
                      .states = states_.data(),
                      .state_size = network_.state_size};
      if (!dones_.empty()) {
        for (std::size_t env = first; env < first + tile.count; ++env) {
          if (dones_[env] != 0) resetEnv(env);
        }
      }
      for (const auto& operation : network_.operations) operation->run(tile);
      for (std::size_t env = 0; env < tile.count; ++env) decide(tile, env, parts_[part]);
    }
  }

  void decide(const Tile& tile, std::size_t n, Part& part) noexcept {
    const auto value = [&](std::size_t deciding) {
      return tile.value(network_.values[deciding_[deciding]], n);
    };
    policy::ActionValues said;
    std::size_t next = 0;
    if (needs_.continuous_actions > 0) {
      said.mean = value(next++);
      said.log_deviation = value(next++);
    }
    for (const float*& logits : part.logits) logits = value(next++);
    said.logits = part.logits;
    const std::size_t env = tile.first_env + n;
    const std::span<float> actions = actions_.subspan(env * action_count_, action_count_);
    if (options_.samples) {
      const RandomStream random(options_.seed, options_.first_env + static_cast<std::uint32_t>(env),
                                kStream, step_);
      part.sampler.sample(kernels_, said, random, actions);
    } else {
      part.sampler.takeLikeliest(said, actions);
    }
    std::ranges::transform(actions,
                           previous_.begin() + static_cast<std::ptrdiff_t>(env * action_count_),
                           [](float action) { return std::clamp(action, -1.0F, 1.0F); });
  }

  /// Takes the place of the episode number in random streams. No simulation has that many episodes,
  /// so no number is drawn twice.
  static constexpr std::uint64_t kStream = 0x7C7A11C0FFEE0000ULL;

  PolicyInterface needs_;
  OperationList network_;
  policy::Kernels kernels_;
  LearnedPolicyOptions options_;
  std::size_t envs_;
  std::size_t observation_size_;
  std::size_t action_count_;
  std::vector<std::uint32_t> deciding_;
  AlignedFloats states_;
  std::vector<float> previous_;
  std::size_t tile_size_ = 1;
  std::uint32_t step_ = 0;
  std::vector<Part> parts_;
  /// Valid during a call of act().
  policy::NetworkInputs network_inputs_;
  std::span<const std::uint8_t> dones_;
  std::span<float> actions_;
  std::optional<detail::Workers> workers_;
};

Result<LearnedPolicy> LearnedPolicy::create(const PackFile& pack, const PolicyBatch& batch,
                                            const LearnedPolicyOptions& options) {
  ASSIGN_OR_RETURN(PolicyInterface needs, policyInterface(pack));
  RETURN_IF_ERROR(checkBatch(batch));
  RETURN_IF_ERROR(checkActions(pack, needs, batch));
  ASSIGN_OR_RETURN(const auto ranges, findParts(pack, needs, batch));
  const schema::Policy& stored = *pack.root().asset_as_Policy();
  ASSIGN_OR_RETURN(const auto shapes, policy::layerShapes(stored, pack.where() + ": policy"));
  OperationList network = policy::makeOperations(stored, shapes, ranges, decidingLayers(stored));
  return LearnedPolicy(
      std::make_unique<Impl>(stored, std::move(needs), std::move(network), batch, options));
}

LearnedPolicy::LearnedPolicy(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LearnedPolicy::~LearnedPolicy() = default;
LearnedPolicy::LearnedPolicy(LearnedPolicy&&) noexcept = default;
LearnedPolicy& LearnedPolicy::operator=(LearnedPolicy&&) noexcept = default;

void LearnedPolicy::act(const PolicyInputs& inputs, std::span<float> actions) {
  impl_->act(inputs, actions);
}
void LearnedPolicy::reset() noexcept { impl_->reset(); }

void LearnedPolicy::reset(std::uint32_t first_env) noexcept { impl_->reset(first_env); }
const PolicyInterface& LearnedPolicy::interface() const { return impl_->interface(); }
std::size_t LearnedPolicy::threadCount() const { return impl_->threadCount(); }
std::size_t LearnedPolicy::memoryBytes() const { return impl_->memoryBytes(); }

}  // namespace galactic
