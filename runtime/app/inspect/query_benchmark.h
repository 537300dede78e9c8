#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "inspect/query_workload.h"

namespace galactic {

/// Measures batched and scalar queries on these scenes' grids on the calling thread, and returns a
/// table: nanoseconds per query for robots that move steadily and for random places. Takes a few
/// seconds. `scenes` must hold at least one grid each.
[[nodiscard]] std::string runQueryBenchmark(std::span<const SceneGrids> scenes, std::uint32_t seed);

}  // namespace galactic
