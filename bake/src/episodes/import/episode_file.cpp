#include "episodes/import/episode_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "support/try.h"

namespace galactic::bake {
namespace {

/// Indices of the episodes to keep.
Result<std::vector<std::uint32_t>> chosen(const EpisodeFile& file,
                                          const std::optional<std::vector<std::uint32_t>>& only) {
  const std::size_t count = file.episodes.size();
  std::vector<std::uint32_t> indices;
  if (!only) {
    indices.reserve(count);
    for (std::uint32_t n = 0; n < count; ++n) indices.push_back(n);
    return indices;
  }
  indices = *only;
  if (indices.empty()) {
    return fail(ErrorCode::kInvalidInput, file.place, "none is to be kept; name at least one");
  }
  std::set<std::uint32_t> seen;
  for (const std::uint32_t n : indices) {
    if (n >= count) {
      return fail(
          ErrorCode::kInvalidInput, file.place,
          fmt::format("has {} episodes, number {} is to be kept; they count from 0", count, n));
    }
    if (!seen.insert(n).second) {
      return fail(ErrorCode::kInvalidInput, file.place,
                  fmt::format("number {} is to be kept twice; name each once", n));
    }
  }
  return indices;
}

/// Numbers the names that are used, in ascending order of the names.
class UsedNames {
 public:
  explicit UsedNames(const std::vector<std::string>& all) : all_(all) {}

  void use(std::uint32_t index) { used_.insert(all_[index]); }
  [[nodiscard]] std::vector<std::string> names() const { return {used_.begin(), used_.end()}; }
  /// Numbers by the file's index; only valid for names that are used.
  [[nodiscard]] std::vector<std::uint32_t> numbers() const {
    const std::vector<std::string> sorted = names();
    std::vector<std::uint32_t> numbers;
    numbers.reserve(all_.size());
    for (const std::string& name : all_) {
      const auto place = std::lower_bound(sorted.begin(), sorted.end(), name);
      numbers.push_back(static_cast<std::uint32_t>(place - sorted.begin()));
    }
    return numbers;
  }

 private:
  const std::vector<std::string>& all_;
  std::set<std::string> used_;
};

}  // namespace

std::optional<SceneNameFault> renameScenes(std::vector<std::string>& scenes,
                                           const std::map<std::string, std::string>& names) {
  for (const auto& [from, to] : names) {
    if (std::find(scenes.begin(), scenes.end(), from) != scenes.end()) continue;
    return SceneNameFault{std::nullopt,
                          fmt::format("has no scene '{}' to be named '{}'; the first of {} is '{}'",
                                      from, to, scenes.size(), scenes.front())};
  }
  std::set<std::string> taken;
  for (std::size_t n = 0; n < scenes.size(); ++n) {
    const auto renamed = names.find(scenes[n]);
    if (renamed != names.end()) scenes[n] = renamed->second;
    if (taken.insert(scenes[n]).second) continue;
    return SceneNameFault{
        n, fmt::format("'{}' is the name of two scenes; give them names of their own", scenes[n])};
  }
  return std::nullopt;
}

Result<SourceEpisodes> chooseEpisodes(const EpisodeFile& file,
                                      const std::optional<std::vector<std::uint32_t>>& only) {
  ASSIGN_OR_RETURN(const auto kept, chosen(file, only));
  UsedNames scenes(file.scenes);
  UsedNames objects(file.objects);
  SourceEpisodes source;
  source.robot = file.robot;
  source.start_joints = file.start_joints;
  source.warnings = file.warnings;
  source.episodes.reserve(kept.size());
  source.start_positions.reserve(kept.size() * file.start_joints.size());
  for (const std::uint32_t n : kept) {
    const FileEpisode& from = file.episodes[n];
    if (!from.has_start) {
      source.without_start.push_back(static_cast<std::uint32_t>(source.episodes.size()));
    }
    Episode& episode = source.episodes.emplace_back(from.episode);
    scenes.use(episode.scene);
    episode.first_placement = static_cast<std::uint32_t>(source.placements.size());
    const auto spawns =
        std::span(file.spawns).subspan(from.episode.first_placement, from.episode.placement_count);
    for (const Spawn& spawn : spawns) {
      objects.use(spawn.object);
      source.placements.push_back({spawn.object, spawn.pose});
    }
    source.start_positions.insert(source.start_positions.end(), from.start_positions.begin(),
                                  from.start_positions.end());
  }
  source.scenes = scenes.names();
  source.objects = objects.names();
  const auto scene_numbers = scenes.numbers();
  const auto object_numbers = objects.numbers();
  for (Episode& episode : source.episodes) episode.scene = scene_numbers[episode.scene];
  for (Placement& placement : source.placements) {
    placement.object = object_numbers[placement.object];
  }
  return source;
}

}  // namespace galactic::bake
