#include "galactic/bake/episode_rejection.h"

namespace galactic::bake {

std::string_view rejectionName(EpisodeRejection reason) {
  constexpr std::array<std::string_view, kRejectionCount> kNames{
      "distance",       "same_support",  "no_room",        "uneven",      "outside_receptacle",
      "overlap",        "moved",         "tipped",         "placement",   "not_reached",
      "start_distance", "start_blocked", "replay_blocked", "replay_moved"};
  return kNames[static_cast<std::size_t>(reason)];
}

}  // namespace galactic::bake
