#include "galactic/bake/episode_generator.h"

namespace galactic::bake {

std::string_view rejectionName(EpisodeRejection reason) {
  constexpr std::array<std::string_view, kRejectionCount> kNames{
      "distance",           "other_part",     "same_support",  "no_room",        "uneven",
      "outside_receptacle", "overlap",        "moved",         "tipped",         "placement",
      "not_reached",        "start_distance", "start_blocked", "replay_blocked", "replay_moved"};
  return kNames[static_cast<std::size_t>(reason)];
}

std::string textOf(const RejectionCounts& counts) {
  std::string text;
  for (std::size_t n = 0; n < kRejectionCount; ++n) {
    const auto reason = static_cast<EpisodeRejection>(n);
    if (counts[reason] == 0) continue;
    if (!text.empty()) text += ", ";
    text.append(rejectionName(reason)).append(" ").append(std::to_string(counts[reason]));
  }
  return text.empty() ? "nothing" : text;
}

}  // namespace galactic::bake
