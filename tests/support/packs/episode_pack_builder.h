#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/episode_set.h"
#include "support/packs/pack_parts.h"

namespace galactic::test {

/// All that an episode pack holds. buildPack makes a pack that is valid in every field that was
/// left as it is.
struct EpisodePackFields {
  PackKind kind = PackKind::kEpisodes;
  std::string name = "tidy";
  std::vector<std::string> scenes{"kitchen"};
  std::vector<std::string> objects{"bowl", "mug"};
  std::string robot = "helper";
  std::vector<std::string> start_joints{"elbow", "lift"};
  std::vector<float> start_positions;
  std::vector<Placement> placements;
  std::vector<Episode> episodes;
};

/// Two episodes in the scene of smallScene() with the objects of smallObjects() and the robot of
/// smallRobotPack(): the first with three objects, the second with one.
EpisodePackFields smallEpisodes();

/// The whole file: header and payload.
AlignedBytes buildPack(const EpisodePackFields& fields);

}  // namespace galactic::test
