#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "inspect/query_workload.h"

namespace galactic {

/// Measures batched and scalar queries of the grids of `scenes` on the calling thread, and returns
/// a table of nanoseconds per query for robots that move steadily and for random places. Takes a
/// few seconds. Each scene must have at least one grid.
[[nodiscard]] std::string runQueryBenchmark(std::span<const SceneGrids> scenes, std::uint32_t seed);

}  // namespace galactic
