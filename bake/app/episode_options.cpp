#include <fmt/format.h>

#include <charconv>
#include <system_error>
#include <utility>

#include "option_groups.h"
#include "option_values.h"

namespace galactic::bake {
namespace {

Result<std::uint64_t> parseSeed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (problem == std::errc() && end == text.data() + text.size()) return seed;
  return fail(ErrorCode::kInvalidInput, "--seed",
              fmt::format("is \"{}\", a whole number from 0 on is wanted for episodes", text));
}

/// The first of `options` that was typed.
std::string typedOf(const std::vector<CLI::Option*>& options) {
  for (const CLI::Option* option : options) {
    if (option->count() > 0) return option->get_name();
  }
  return {};
}

}  // namespace

void EpisodeSetOptions::addTo(CLI::App& app, BakeCommand& command) {
  EpisodeSamplerOptions& sample = command.episodes.sample;
  for_import_ = {
      app.add_option("--only", command.episodes.only,
                     "Import: keep the episodes whose indices stand in this text file")
          ->type_name("FILE"),
      app.add_option("--scene-name", scene_names_,
                     "Import: the name of a scene's pack for that of the file (may be repeated)")
          ->type_name("OLD=NEW")
          ->allow_extra_args(false),
      app.add_option("--start-joints", start_joints_,
                     "Import: the joints of robotStartJointPositions (default: Fetch's arm)")
          ->type_name("NAME,NAME,...")
          ->delimiter(',')
          ->allow_extra_args(false),
      app.add_option(
             "--object-up", object_up_,
             "Import: up axis of the objects' frames in the file (default: z; Habitat's: y)")
          ->type_name("AXIS"),
      app.add_option("--object-pack", command.episodes.object_pack,
                     "Import of Habitat's: the objects' pack, which says where their centres are")
          ->type_name("PACK"),
      app.add_option("--targets", targets_,
                     "Import of Habitat's: the first target of an episode, or each as an episode")
          ->check(CLI::IsMember({"first", "each"}))
          ->capture_default_str()};
  for_sampling_ = {
      app.add_option("--count", sample.episodes, "Sampling: how many episodes")
          ->check(CLI::Range(1, 1'000'000))
          ->capture_default_str(),
      app.add_option("--objects", sample.objects,
                     "Sampling: objects of each episode, the target among them")
          ->check(CLI::Range(1, 1024))
          ->capture_default_str(),
      app.add_option("--heights", heights_,
                     "Sampling: objects stand this high above the floor, metres (default 0.3,1.2)")
          ->type_name("LOW,HIGH"),
      app.add_option("--least-distance", least_distance_,
                     "Sampling: from target to goal, metres (default 1)")
          ->type_name("METRES")};
}

Result<void> EpisodeSetOptions::understandImport(BakeCommand& command) const {
  EpisodeImportOptions& import = command.episodes.import;
  if (!object_up_.empty()) {
    const auto up = parseUp(object_up_, "--object-up");
    if (!up) return tl::unexpected(up.error());
    import.object_up = *up;
  }
  import.targets = targets_ == "each" ? HabitatTargets::kEach : HabitatTargets::kFirst;
  if (!start_joints_.empty()) import.start_joints = start_joints_;
  for (const std::string& text : scene_names_) {
    auto names = parsePair(text, "--scene-name", "OLD=NEW");
    if (!names) return tl::unexpected(names.error());
    const auto [place, fresh] = import.scene_names.insert(std::move(*names));
    if (!fresh) {
      return fail(ErrorCode::kInvalidInput, "--scene-name",
                  fmt::format("names {} twice; give each scene once", place->first));
    }
  }
  return {};
}

Result<void> EpisodeSetOptions::understandSampling(BakeCommand& command,
                                                   const std::vector<std::string>& seeds) const {
  EpisodeSamplerOptions& sample = command.episodes.sample;
  if (seeds.size() > 1) {
    return fail(ErrorCode::kInvalidInput, "--seed", "is given twice; episodes have one seed");
  }
  if (!seeds.empty()) {
    const auto seed = parseSeed(seeds.front());
    if (!seed) return tl::unexpected(seed.error());
    sample.seed = *seed;
  }
  if (!heights_.empty()) {
    const auto heights = parseExactly(heights_, "--heights", 2);
    if (!heights) return tl::unexpected(heights.error());
    sample.lowest = static_cast<float>((*heights)[0]);
    sample.highest = static_cast<float>((*heights)[1]);
  }
  if (!least_distance_.empty()) {
    const auto distance = parseExactly(least_distance_, "--least-distance", 1);
    if (!distance) return tl::unexpected(distance.error());
    sample.least_distance = static_cast<float>((*distance)[0]);
  }
  return {};
}

Result<void> EpisodeSetOptions::understand(BakeCommand& command,
                                           const std::vector<std::string>& seeds) {
  if (command.kind != AssetKind::kEpisodes) return {};
  const bool sampled = command.episodes.sampled;
  std::string wrong = typedOf(sampled ? for_import_ : for_sampling_);
  if (!sampled && wrong.empty() && !seeds.empty()) wrong = "--seed";
  if (!wrong.empty()) {
    return fail(ErrorCode::kInvalidInput, wrong,
                sampled ? "goes with the import of *.episode_set.json; the inputs are packs, in "
                          "which episodes are sampled: leave it out"
                        : "goes with the sampling of episodes in packs; the inputs are episode "
                          "sets, which are imported: leave it out");
  }
  return sampled ? understandSampling(command, seeds) : understandImport(command);
}

void EpisodeSetOptions::remember(BakeCommand& command) const {
  if (command.episodes.sampled) {
    const EpisodeSamplerOptions& sample = command.episodes.sample;
    command.remember("count", std::to_string(sample.episodes));
    command.remember("objects", std::to_string(sample.objects));
    command.remember("seed", std::to_string(sample.seed));
    command.remember("heights", fmt::format("{},{}", sample.lowest, sample.highest));
    command.remember("least-distance", fmt::format("{}", sample.least_distance));
    return;
  }
  command.remember("only", command.episodes.only.filename().string());
  for (const std::string& names : scene_names_) command.remember("scene-name", names);
  command.remember("start-joints", joined(command.episodes.import.start_joints));
  command.remember("object-up", object_up_);
  command.remember("object-pack", command.episodes.object_pack.filename().string());
  if (command.episodes.import.targets == HabitatTargets::kEach) {
    command.remember("targets", targets_);
  }
}

}  // namespace galactic::bake
