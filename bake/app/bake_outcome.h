#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "galactic/bake/scene_baker.h"

namespace galactic::bake {

/// What became of one input.
struct BakeOutcome {
  std::filesystem::path input;
  std::filesystem::path output;
  /// How axes and unit were read.
  std::string convention;
  BakedScene scene;
  StageTimes times;
  /// Size of the pack; 0 for a dry run.
  std::uint64_t pack_bytes = 0;
};

}  // namespace galactic::bake
