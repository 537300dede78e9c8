#pragma once
#include <span>
#include <vector>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// Elements of the part that tells the tilt of the target.
inline constexpr std::size_t kTargetUpSize = 3;

/// Elements that tell of one object near the hand: the way to it.
inline constexpr std::size_t kWaySize = 3;
/// Objects that are further from the hand than this are not observed, meters.
inline constexpr float kFarthestSeen = 1;

/// Elements of the optional parts of an observation; 0 for none.
struct SensorSizes {
  std::size_t bump = 0;
  std::size_t target_goal = 0;
  std::size_t target_up = 0;
  std::size_t near_objects = 0;
  std::size_t laser = 0;
  std::size_t geodesic = 0;
  std::size_t last_actions = 0;
};

/// The parts of an observation: see BatchSimulator::observationParts.
[[nodiscard]] std::vector<ObservationPart> observationParts(std::size_t joints,
                                                            const SensorSizes& sensors);

/// Elements of the parts that sense() writes, which are the last ones of a row.
[[nodiscard]] std::size_t sensedSize(const SensorSizes& sensors);

/// Writes the observations of the envs of a chunk, whose first one is `first`, but for their
/// sensors.
void observe(const Model& model, BatchState& state, std::size_t first) noexcept;

/// Writes those of the sensors of one env to their place in the whole row `out`.
void sense(const Model& model, const BatchState& state, std::size_t env,
           std::span<float> out) noexcept;

/// The same for the chunk's envs.
void senseAll(const ChunkStep& step) noexcept;

}  // namespace galactic::simulation
