#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "support/printable.h"
#include "terminal.h"
#include "views.h"

namespace galactic::bake {
namespace {

/// From the target's start to its goal, meters.
struct Distances {
  double min = 0;
  double mean = 0;
  double max = 0;
};

Distances targetDistances(const SourceEpisodes& set) {
  Distances distances;
  for (const Episode& episode : set.episodes) {
    const Vec3 start = set.placements[episode.first_placement + episode.target].pose.translation;
    const Vec3 way = episode.goal.translation - start;
    const double length = std::sqrt(static_cast<double>(dot(way, way)));
    const bool first = &episode == set.episodes.data();
    distances.min = first ? length : std::min(distances.min, length);
    distances.max = std::max(distances.max, length);
    distances.mean += length / static_cast<double>(set.episodes.size());
  }
  return distances;
}

std::uint32_t mostPlacements(const SourceEpisodes& set) {
  std::uint32_t most = 0;
  for (const Episode& episode : set.episodes) most = std::max(most, episode.placement_count);
  return most;
}

/// "14 of 16; not: 2 no grasp".
std::string textOf(const SolvedSample& sample) {
  std::vector<std::string> ends;
  ends.reserve(sample.unsolved.size());
  for (const auto& [end, count] : sample.unsolved) ends.push_back(fmt::format("{} {}", count, end));
  return fmt::format("{} of {}{}{}", sample.solved, sample.episodes,
                     ends.empty() ? "" : "; not: ", fmt::join(ends, ", "));
}

void printGeneration(const EpisodeGeneration& generation, Verbosity verbosity) {
  fmt::print("  drawn and not taken: {}\n", textOf(generation.rejections));
  if (generation.sample.episodes > 0) {
    fmt::print("  the scripted policy solves {}\n", textOf(generation.sample));
  }
  if (verbosity != Verbosity::kVerbose) return;
  for (const GeneratedScene& scene : generation.scenes) {
    fmt::print(
        "  {}: {} episodes; {} floor places, {} support places on {} surfaces, {} "
        "receptacles{}\n",
        printable(scene.name), scene.episodes, scene.floor_places, scene.support_places,
        scene.surfaces, scene.receptacles, scene.has_mesh ? ", objects settled" : "");
  }
}

Json generationReport(const EpisodeGeneration& generation) {
  Json rejections = Json::object();
  for (std::size_t n = 0; n < kRejectionCount; ++n) {
    const auto reason = static_cast<EpisodeRejection>(n);
    rejections[std::string(rejectionName(reason))] = generation.rejections[reason];
  }
  Json scenes = Json::array();
  for (const GeneratedScene& scene : generation.scenes) {
    scenes.push_back({{"name", scene.name},
                      {"episodes", scene.episodes},
                      {"floor_places", scene.floor_places},
                      {"support_places", scene.support_places},
                      {"surfaces", scene.surfaces},
                      {"receptacles", scene.receptacles},
                      {"settled", scene.has_mesh}});
    if (scene.skipped > 0) scenes.back()["skipped"] = scene.skipped;
    if (scene.shortened_way) scenes.back()["shortened_way"] = *scene.shortened_way;
  }
  Json left_out = Json::array();
  for (const UnusableScene& scene : generation.left_out) {
    left_out.push_back({{"scene", scene.name}, {"reason", scene.reason}});
  }
  Json report{{"rejections", std::move(rejections)},
              {"scenes", std::move(scenes)},
              {"left_out", std::move(left_out)}};
  if (generation.skipped > 0) report["skipped"] = generation.skipped;
  if (generation.with_fewer_objects > 0) {
    report["with_fewer_objects"] = generation.with_fewer_objects;
  }
  const SolvedSample& sample = generation.sample;
  if (sample.episodes > 0) {
    report["scripted_policy"] = {
        {"episodes", sample.episodes}, {"solved", sample.solved}, {"unsolved", sample.unsolved}};
  }
  return report;
}

}  // namespace

void printTable(const EpisodeOutcome& outcome, const Made& made, Verbosity verbosity) {
  const SourceEpisodes& set = outcome.episodes;
  const Distances distances = targetDistances(set);
  fmt::print("{} -> {}\n", printable(outcome.input),
             made.pack_bytes > 0 ? made.output.string() : "(dry run)");
  fmt::print("  {}: {} episodes; {} scenes, {} objects, {} placements, at most {} in an episode\n",
             printable(set.name), set.episodes.size(), set.scenes.size(), set.objects.size(),
             set.placements.size(), mostPlacements(set));
  fmt::print("  target to goal {:.2f} m at least, {:.2f} m on average, {:.2f} m at most\n",
             distances.min, distances.mean, distances.max);
  if (verbosity == Verbosity::kVerbose) {
    fmt::print("  scenes: {}\n", printable(fmt::format("{}", fmt::join(set.scenes, ", "))));
    fmt::print("  objects: {}\n", printable(fmt::format("{}", fmt::join(set.objects, ", "))));
    if (!set.start_joints.empty()) {
      fmt::print("  start joints: {}\n",
                 printable(fmt::format("{}", fmt::join(set.start_joints, ", "))));
    }
  }
  if (outcome.generation) printGeneration(*outcome.generation, verbosity);
  printWarnings(set.warnings, verbosity);
  fmt::print("  {:.3f} s; {:.2f} MB\n", outcome.seconds,
             static_cast<double>(made.pack_bytes) / 1e6);
}

Json reportEntries(const EpisodeOutcome& outcome, const Made& made) {
  const SourceEpisodes& set = outcome.episodes;
  const Distances distances = targetDistances(set);
  Json entry{{"input", outcome.input},
             {"output", made.output.string()},
             {"pack_bytes", made.pack_bytes},
             {"name", set.name},
             {"robot", set.robot},
             {"episodes", set.episodes.size()},
             {"placements", set.placements.size()},
             {"most_placements", mostPlacements(set)},
             {"scenes", set.scenes},
             {"objects", set.objects},
             {"start_joints", set.start_joints},
             {"target_to_goal",
              {{"min", distances.min}, {"mean", distances.mean}, {"max", distances.max}}},
             {"seconds", outcome.seconds},
             {"warnings", withFlags(set.warnings)}};
  if (outcome.generation) entry["generation"] = generationReport(*outcome.generation);
  return Json::array({std::move(entry)});
}

}  // namespace galactic::bake
