#pragma once
#include <filesystem>
#include <vector>

#include "bake_outcome.h"
#include "galactic/error.h"

namespace galactic::bake {

/// An input that could not be baked.
struct BakeFailure {
  std::filesystem::path input;
  Error error;
};

/// Writes what was done as JSON, atomically. Lengths in metres, times in seconds.
[[nodiscard]] Result<void> writeReport(const std::filesystem::path& path,
                                       const std::vector<BakeOutcome>& outcomes,
                                       const std::vector<BakeFailure>& failures);

}  // namespace galactic::bake
