#define XXH_INLINE_ALL
#include "episodes/generation_options.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <cmath>
#include <utility>

namespace galactic::bake {
namespace {

auto refuse(std::string message) {
  return fail(ErrorCode::kInvalidInput, "episodes", std::move(message));
}

/// The upper end may be infinite.
Result<void> checkDistances(const DistanceRange& range, std::string_view what) {
  if (std::isfinite(range.least) && range.least >= 0 && range.least <= range.most) return {};
  return refuse(
      fmt::format("{} from {} to {} m is not a range; give the shorter one first, 0 or more", what,
                  range.least, range.most));
}

}  // namespace

Result<void> checkOptions(const EpisodeGeneratorOptions& options) {
  if (options.episodes == 0) return refuse("0 episodes are asked for; ask for at least 1");
  const CountRange& objects = options.objects;
  if (objects.least == 0) return refuse("0 objects are asked for; an episode needs at least 1");
  if (objects.least > objects.most) {
    return refuse(fmt::format("{} to {} objects are no range; give the smaller number first",
                              objects.least, objects.most));
  }
  const DistanceRange& heights = options.heights;
  if (!(heights.least < heights.most) || !std::isfinite(heights.least) ||
      !std::isfinite(heights.most)) {
    return refuse(fmt::format("heights from {} to {} m are no range; give the lower one first",
                              heights.least, heights.most));
  }
  if (!(options.flatness > 0) || options.flatness > kMostFlatness) {
    return refuse(fmt::format("a flatness of {} m is asked for; give more than 0, at most {}",
                              options.flatness, kMostFlatness));
  }
  if (auto checked = checkDistances(options.target_to_goal, "the way from target to goal");
      !checked) {
    return checked;
  }
  if (auto checked = checkDistances(options.start_to_target, "the way from start to target");
      !checked) {
    return checked;
  }
  if (!(options.most_skipped >= 0 && options.most_skipped <= 1)) {
    return refuse(fmt::format("the share of episodes that may be skipped is {}; give 0 to 1",
                              options.most_skipped));
  }
  const float held_out = options.split.held_out;
  if (held_out >= 0 && held_out <= 1) return {};
  return refuse(fmt::format("the share of scenes held out is {}; give 0 to 1", held_out));
}

bool isHeldOut(std::string_view scene, const SceneSplit& split) {
  const std::uint64_t hash = XXH3_64bits_withSeed(scene.data(), scene.size(), split.seed);
  return static_cast<double>(hash >> 11U) * 0x1p-53 < static_cast<double>(split.held_out);
}

std::string textOf(const DistanceRange& range) {
  return std::isfinite(range.most) ? fmt::format("{} to {} m", range.least, range.most)
                                   : fmt::format("{} m or more", range.least);
}

}  // namespace galactic::bake
