#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "galactic/number_text.h"
#include "option_groups.h"
#include "option_values.h"

namespace galactic::bake {
namespace {

const std::map<std::string, SplitSide>& splitNames() {
  static const std::map<std::string, SplitSide> names{{"train", SplitSide::kTrain},
                                                      {"validation", SplitSide::kValidation}};
  return names;
}

const std::map<std::string, SupportChoice>& supportNames() {
  static const std::map<std::string, SupportChoice> names{
      {"both", SupportChoice::kBoth},
      {"found", SupportChoice::kFound},
      {"receptacles", SupportChoice::kReceptacles}};
  return names;
}

Result<std::uint64_t> parseSeed(const std::string& text) {
  std::uint64_t seed = 0;
  if (wholeFault(text, 0, std::numeric_limits<std::uint64_t>::max()).empty()) {
    (void)std::from_chars(text.data(), text.data() + text.size(), seed);
    return seed;
  }
  return fail(ErrorCode::kInvalidInput, "--seed",
              fmt::format("is \"{}\", a whole number from 0 on is wanted for episodes", text));
}

/// N, or LEAST,MOST.
Result<CountRange> parseCounts(const std::string& text, const char* option) {
  const auto numbers = parseNumbers(text, option);
  if (!numbers) return tl::unexpected(numbers.error());
  constexpr double kMost = 1024;
  const auto is_count = [](double number) {
    return number == std::floor(number) && number >= 1 && number <= kMost;
  };
  if (numbers->size() <= 2 && is_count(numbers->front()) && is_count(numbers->back())) {
    return CountRange{static_cast<std::uint32_t>(numbers->front()),
                      static_cast<std::uint32_t>(numbers->back())};
  }
  return fail(
      ErrorCode::kInvalidInput, option,
      fmt::format("is \"{}\", a whole number from 1 to {} or two of them are wanted", text, kMost));
}

/// LEAST, or LEAST,MOST; `range` stays as it is when the text is empty.
Result<void> parseDistances(const std::string& text, const char* option, DistanceRange& range) {
  if (text.empty()) return {};
  const auto numbers = parseNumbers(text, option);
  if (!numbers) return tl::unexpected(numbers.error());
  if (numbers->size() > 2) {
    return fail(
        ErrorCode::kInvalidInput, option,
        fmt::format("has {} numbers in \"{}\", one or two are wanted", numbers->size(), text));
  }
  range = {.least = static_cast<float>(numbers->front())};
  if (numbers->size() == 2) range.most = static_cast<float>(numbers->back());
  return {};
}

std::string textOf(const DistanceRange& range) {
  if (std::isinf(range.most)) return fmt::format("{}", range.least);
  return fmt::format("{},{}", range.least, range.most);
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
  addGeneration(app, command);
}

void EpisodeSetOptions::addGeneration(CLI::App& app, BakeCommand& command) {
  EpisodeGeneratorOptions& generate = command.episodes.generate;
  for_generation_ = {
      app.add_option("--count", generate.episodes, "Generate: how many episodes")
          ->check(wholeCheck(1, 1'000'000))
          ->capture_default_str(),
      app.add_option("--objects", objects_,
                     "Generate: objects of each episode, the target among them (default 10)")
          ->type_name("N|LEAST,MOST"),
      app.add_option("--heights", heights_,
                     "Generate: objects stand this high above the floor, metres (default 0.3,1.2)")
          ->type_name("LOW,HIGH"),
      app.add_option("--flatness", generate.flatness,
                     "Generate: how far the surface under an object may be from flat, metres; "
                     "scans need about 0.01")
          ->check(numberCheck(1e-6, static_cast<double>(kMostFlatness)))
          ->capture_default_str(),
      app.add_option("--goal-distance", goal_distance_,
                     "Generate: from target to goal, metres (default 1, less in small scenes)")
          ->type_name("LEAST[,MOST]"),
      app.add_option("--start-distance", start_distance_,
                     "Generate: from the robot to the target on the ground, metres (default 0)")
          ->type_name("LEAST[,MOST]"),
      app.add_option("--most-skipped", generate.most_skipped,
                     "Generate: share of the episodes that may find no place; they are skipped")
          ->check(numberCheck(0, 1))
          ->type_name("SHARE")
          ->capture_default_str(),
      app.add_flag("--goal-elsewhere", generate.goal_on_other_support,
                   "Generate: goals lie on another surface than their targets"),
      app.add_option("--supports", generate.supports,
                     "Generate: objects stand on all surfaces that are found, in the dataset's "
                     "receptacles, or half of them in these where a scene has any (default: both)")
          ->transform(CLI::CheckedTransformer(supportNames()))
          ->option_text("found|receptacles|both"),
      app.add_option("--geometry", geometry_,
                     "Generate: the mesh a scene was baked from, to settle objects on (may be "
                     "repeated)")
          ->type_name("SCENE=FILE")
          ->allow_extra_args(false),
      app.add_option("--split", generate.split.side, "Generate: use one part of the scenes")
          ->transform(CLI::CheckedTransformer(splitNames()))
          ->option_text("train|validation"),
      app.add_option("--held-out", held_out_,
                     "Generate: share of the scenes that is for validation (default 0.2)")
          ->type_name("SHARE"),
      app.add_option("--split-seed", generate.split.seed,
                     "Generate: the number that decides which scenes are held out")
          ->check(wholeCheck(0, std::numeric_limits<std::uint64_t>::max()))
          ->capture_default_str(),
      app.add_option("--solve", command.episodes.solve,
                     "Generate: of how many episodes to say whether the scripted policy solves "
                     "them; 0: none")
          ->check(wholeCheck(0, 1'000'000))
          ->capture_default_str()};
  split_ = app.get_option("--split");
}

Result<void> EpisodeSetOptions::understandImport(BakeCommand& command) const {
  EpisodeImportOptions& import = command.episodes.import;
  if (!object_up_.empty()) {
    const auto up = parseUp(object_up_, "--object-up");
    if (!up) return tl::unexpected(up.error());
    import.object_up = *up;
  }
  import.targets = targets_ == "each" ? HabitatTargets::kEach : HabitatTargets::kFirst;
  if (!start_joints_.empty()) {
    auto joints = parseNames(start_joints_, "--start-joints");
    if (!joints) return tl::unexpected(joints.error());
    import.start_joints = std::move(*joints);
  }
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

Result<void> EpisodeSetOptions::understandGeneration(BakeCommand& command,
                                                     const std::vector<std::string>& seeds) const {
  EpisodeGeneratorOptions& generate = command.episodes.generate;
  generate.jobs = command.jobs;
  if (seeds.size() > 1) {
    return fail(ErrorCode::kInvalidInput, "--seed", "is given twice; episodes have one seed");
  }
  if (!seeds.empty()) {
    const auto seed = parseSeed(seeds.front());
    if (!seed) return tl::unexpected(seed.error());
    generate.seed = *seed;
  }
  if (!objects_.empty()) {
    const auto objects = parseCounts(objects_, "--objects");
    if (!objects) return tl::unexpected(objects.error());
    generate.objects = *objects;
  }
  if (!heights_.empty()) {
    const auto heights = parseExactly(heights_, "--heights", 2);
    if (!heights) return tl::unexpected(heights.error());
    generate.heights = {static_cast<float>((*heights)[0]), static_cast<float>((*heights)[1])};
  }
  if (!held_out_.empty()) {
    const auto held_out = parseExactly(held_out_, "--held-out", 1);
    if (!held_out) return tl::unexpected(held_out.error());
    generate.split.held_out = static_cast<float>((*held_out)[0]);
  }
  generate.shorten_way = goal_distance_.empty();
  if (auto parsed = parseDistances(goal_distance_, "--goal-distance", generate.target_to_goal);
      !parsed) {
    return parsed;
  }
  if (auto parsed = parseDistances(start_distance_, "--start-distance", generate.start_to_target);
      !parsed) {
    return parsed;
  }
  return understandGeometry(command);
}

Result<void> EpisodeSetOptions::understandGeometry(BakeCommand& command) const {
  for (const std::string& text : geometry_) {
    auto pair = parsePair(text, "--geometry", "SCENE=FILE");
    if (!pair) return tl::unexpected(pair.error());
    const auto [place, fresh] = command.episodes.geometry.insert(std::move(*pair));
    if (!fresh) {
      return fail(ErrorCode::kInvalidInput, "--geometry",
                  fmt::format("names {} twice; give each scene once", place->first));
    }
  }
  return {};
}

Result<void> EpisodeSetOptions::understand(BakeCommand& command,
                                           const std::vector<std::string>& seeds) {
  if (command.kind != AssetKind::kEpisodes) return {};
  const bool generated = command.episodes.generated;
  for (const CLI::Option* option : for_generation_) {
    const bool is_of_split =
        option->get_name() == "--held-out" || option->get_name() == "--split-seed";
    if (!is_of_split || option->count() == 0 || split_->count() > 0) continue;
    return fail(ErrorCode::kInvalidInput, option->get_name(),
                "is about --split; add it, or leave this out");
  }
  std::string wrong = typedOf(generated ? for_import_ : for_generation_);
  if (!generated && wrong.empty() && !seeds.empty()) wrong = "--seed";
  if (!wrong.empty()) {
    return fail(ErrorCode::kInvalidInput, wrong,
                generated ? "goes with the import of *.episode_set.json; the inputs are packs, in "
                            "which episodes are generated: leave it out"
                          : "goes with the generation of episodes in packs; the inputs are episode "
                            "sets, which are imported: leave it out");
  }
  return generated ? understandGeneration(command, seeds) : understandImport(command);
}

void EpisodeSetOptions::rememberGeneration(BakeCommand& command) {
  const EpisodeGeneratorOptions& generate = command.episodes.generate;
  const CountRange& objects = generate.objects;
  command.remember("count", std::to_string(generate.episodes));
  command.remember("objects", fmt::format("{},{}", objects.least, objects.most));
  command.remember("seed", std::to_string(generate.seed));
  command.remember("heights", textOf(generate.heights));
  command.remember("flatness", fmt::format("{}", generate.flatness));
  command.remember("goal-distance", textOf(generate.target_to_goal));
  command.remember("start-distance", textOf(generate.start_to_target));
  if (generate.goal_on_other_support) command.remember("goal-elsewhere", "true");
  command.remember("supports", nameOf(supportNames(), generate.supports));
  for (const auto& [scene, file] : command.episodes.geometry) {
    command.remember("geometry", scene + "=" + file.filename().string());
  }
  if (generate.split.side == SplitSide::kAll) return;
  command.remember("split", nameOf(splitNames(), generate.split.side));
  command.remember("held-out", fmt::format("{}", generate.split.held_out));
  command.remember("split-seed", std::to_string(generate.split.seed));
}

void EpisodeSetOptions::remember(BakeCommand& command) const {
  if (command.episodes.generated) return rememberGeneration(command);
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
