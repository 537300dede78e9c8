#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// What the caller gives for a step of the whole batch.
struct StepInput {
  /// Env after env, not padded.
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
/// By phase.
inline constexpr std::array<std::string_view, 10> kPhaseNames{
    "actions", "propose", "floor",   "kinematics", "collide",
    "hands",   "task",    "observe", "sense",      "renew"};
static_assert(kPhaseNames.size() == static_cast<std::size_t>(Phase::kRenew) + 1);
using PhaseSeconds = std::array<double, kPhaseNames.size()>;

/// Copies the actions of the chunk's envs, clamped; what is not a number becomes 0 and is counted.
/// Envs that are only padding get 0.
void readActions(const ChunkStep& step, std::span<const float> all) noexcept;

/// The end of a step, once robots and hands are where it leaves them: judges and observes it, and
/// begins the next episodes of those that ended and those that the caller asks for (`resets`:
/// empty, or one per env of the batch).
void finishStep(const ChunkStep& step, std::span<const std::int32_t> resets) noexcept;

/// One step of the chunk's envs.
void stepChunk(const ChunkStep& step, const StepInput& input) noexcept;

/// The same, adding to `seconds` how long the processor worked on each phase.
void stepChunkMeasured(const ChunkStep& step, const StepInput& input,
                       PhaseSeconds& seconds) noexcept;

}  // namespace galactic::simulation
