#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>
#include <vector>

#include "support/text/counted.h"
#include "support/text/printable.h"
#include "terminal.h"
#include "views.h"

namespace galactic::bake {
namespace {

/// For example "14 of 16; not: 2 no grasp".
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
    fmt::print("  {}: {}; {} in {}, {} on {}, {}{}\n", printable(scene.name),
               counted(scene.episodes, "episode"), counted(scene.floor_places, "floor place"),
               counted(scene.floor_parts, "part"), counted(scene.support_places, "support place"),
               counted(scene.surfaces, "surface"), counted(scene.receptacles, "receptacle"),
               scene.has_mesh ? ", objects settled" : "");
  }
}

}  // namespace

void printEpisodes(const EpisodeFigures& set, Verbosity verbosity) {
  const EpisodeFigures::Distances& distances = set.target_to_goal;
  fmt::print("  {}: {}; {}, {}, {}, at most {} in an episode\n", printable(set.name),
             counted(set.episodes, "episode"), counted(set.scenes.size(), "scene"),
             counted(set.objects.size(), "object"), counted(set.placements, "placement"),
             set.most_placements);
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
  if (set.generation) printGeneration(*set.generation, verbosity);
}

void printTable(const EpisodeFigures& set, const PackFigures& pack, Verbosity verbosity) {
  fmt::print("{} -> {}\n", printable(set.input), targetOf(pack));
  printEpisodes(set, verbosity);
  printWarnings(warningsOf(pack), verbosity);
  fmt::print("  {:.3f} s; {:.2f} MB\n", set.seconds, static_cast<double>(pack.pack_bytes) / 1e6);
}

}  // namespace galactic::bake
