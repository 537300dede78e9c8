#pragma once
#include <span>
#include <vector>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// Elements of the optional parts of an observation; 0 for none.
struct SensorSizes {
  std::size_t bump = 0;
  std::size_t target_goal = 0;
  std::size_t laser = 0;
  std::size_t geodesic = 0;
};

/// The parts of an observation: see BatchSimulator::observationParts.
[[nodiscard]] std::vector<ObservationPart> observationParts(std::size_t joints,
                                                            const SensorSizes& sensors);

/// Writes the observation of one env but for its sensors, and that of its sensors, each to its
/// place in the whole row `out`.
void observe(const Model& model, const BatchState& state, std::size_t env,
             std::span<float> out) noexcept;
void sense(const Model& model, const BatchState& state, std::size_t env,
           std::span<float> out) noexcept;

/// The same for the chunk's envs.
void observeAll(const ChunkStep& step) noexcept;
void senseAll(const ChunkStep& step) noexcept;

}  // namespace galactic::simulation
