#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "policy/buffer_plan.h"
#include "policy/kernels.h"
#include "policy/layer_shapes.h"

namespace galactic::schema {
struct Policy;
}

namespace galactic::policy {

/// What a network reads for each env of the batch, env by env.
struct NetworkInputs {
  const float* observations = nullptr;
  std::size_t observation_size = 0;
  const std::uint8_t* color = nullptr;
  /// Bytes per pixel.
  std::size_t color_bytes = 0;
  const float* depth = nullptr;
  const float* previous_actions = nullptr;
  std::size_t action_count = 0;
};

/// Neighboring envs of a batch that are computed together.
struct Tile {
  const Kernels* kernels = nullptr;
  const BufferPlan* plan = nullptr;
  const NetworkInputs* inputs = nullptr;
  /// Memory of the values, for `capacity` envs.
  float* arena = nullptr;
  std::size_t capacity = 0;
  std::size_t first_env = 0;
  std::size_t count = 0;
  /// Recurrent states of all envs of the batch.
  float* states = nullptr;
  std::size_t state_size = 0;

  /// The buffer of env `n` of the tile.
  [[nodiscard]] float* value(BufferId buffer, std::size_t n) const {
    return arena + plan->offset(buffer) * capacity + n * plan->stride(buffer);
  }
  [[nodiscard]] float* state(std::size_t n) const { return states + (first_env + n) * state_size; }
};

/// A step on the way from inputs to outputs, for all envs of a tile. Immutable.
class Operation {
 public:
  Operation() = default;
  virtual ~Operation() = default;
  Operation(const Operation&) = delete;
  Operation& operator=(const Operation&) = delete;
  Operation(Operation&&) = delete;
  Operation& operator=(Operation&&) = delete;

  virtual void run(const Tile& tile) const noexcept = 0;
  /// About how many floats it keeps in addition to the tile's.
  [[nodiscard]] virtual std::size_t weightCount() const noexcept { return 0; }
};

/// Where a part of the observation lies in the simulator's rows.
struct ObservationRange {
  std::size_t first = 0;
  std::size_t size = 0;
};

/// The operations of a network.
struct OperationList {
  std::vector<std::unique_ptr<Operation>> operations;
  BufferPlan plan;
  /// The buffer of each layer's value.
  std::vector<BufferId> values;
  /// Floats of recurrent state per env.
  std::size_t state_size = 0;
};

/// The operations of a policy that has been checked. `shapes` are those of its layers;
/// `observation` has an element for each part of the observation that the policy reads; `kept` are
/// the layers whose values are read after all operations have run.
[[nodiscard]] OperationList makeOperations(const schema::Policy& policy,
                                           std::span<const LayerShape> shapes,
                                           std::span<const ObservationRange> observation,
                                           std::span<const std::uint32_t> kept);

}  // namespace galactic::policy
