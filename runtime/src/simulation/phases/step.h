#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// The caller's input to a step of the whole batch.
struct StepInput {
  /// Env after env, without padding.
  std::span<const float> actions;
  /// Empty, or one per env.
  std::span<const std::int32_t> resets;
};

/// The phases of a step, in order.
enum class Phase : std::uint8_t {
  kActions,
  kPropose,
  kFloor,
  kKinematics,
  kCollide,
  kHands,
  kTask,
  kObserve,
  kSense,
  kRenew,
};
/// Indexed by phase.
inline constexpr std::array<std::string_view, 10> kPhaseNames{
    "actions", "propose", "floor",   "kinematics", "collide",
    "hands",   "task",    "observe", "sense",      "renew"};
static_assert(kPhaseNames.size() == static_cast<std::size_t>(Phase::kRenew) + 1);
using PhaseSeconds = std::array<double, kPhaseNames.size()>;

/// Copies and clamps the actions of the chunk's envs; NaN becomes 0 and is counted. Padding envs
/// get 0.
void readActions(const ChunkStep& step, std::span<const float> all) noexcept;

/// Finishes a step after robots and hands have moved: judges and observes it, begins the next
/// episode in envs whose episode has ended, and begins the episodes that the caller asks for
/// (`resets`: empty, or one per env of the batch).
void finishStep(const ChunkStep& step, std::span<const std::int32_t> resets) noexcept;

/// Steps the chunk's envs.
void stepChunk(const ChunkStep& step, const StepInput& input) noexcept;

/// The same, and adds the processor time of each phase to `seconds`.
void stepChunkMeasured(const ChunkStep& step, const StepInput& input,
                       PhaseSeconds& seconds) noexcept;

}  // namespace galactic::simulation
