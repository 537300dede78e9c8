#include "report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <span>
#include <string>

#include "support/files/atomic_file.h"
#include "support/text/counted.h"
#include "support/text/printable.h"
#include "terminal.h"
#include "views.h"

namespace galactic::bake {
namespace {

/// An object that begins with the member `key`, followed by those of `rest`.
Json named(const char* key, std::string value, const Json& rest) {
  Json json{{key, std::move(value)}};
  json.update(rest);
  return json;
}

Json entriesOf(const PackFigures& figures) {
  return reportEntries(figures, [](const std::string& sentence) { return withFlags(sentence); });
}

Json errorOf(const BakeFailure& failure) {
  return {{"code", static_cast<int>(failure.error.code)},
          {"where", placeOf(failure.error)},
          {"message", withFlags(failure.error.message)}};
}

/// The options of a job that have a value, by name. Numbers and switches keep their types, files
/// lose their folders, and several values become a list.
class OptionValues final : public OptionVisitor {
 public:
  using OptionVisitor::option;
  void option(const OptionInfo& info, OptionField& field) override {
    for (std::filesystem::path* path : field.paths()) {
      *path = path->has_filename() ? path->filename() : path->parent_path().filename();
    }
    Json values = Json::array();
    for (const std::string& text : field.texts()) values.push_back(valueOf(field.kind(), text));
    if (values.empty()) return;
    json[std::string(info.name)] = values.size() == 1 ? Json(values.front()) : std::move(values);
  }

  Json json = Json::object();

 private:
  static Json valueOf(OptionKind kind, const std::string& text) {
    if (kind == OptionKind::kSwitch) return true;
    const bool is_number = kind == OptionKind::kNumber || kind == OptionKind::kWhole;
    if (!is_number && kind != OptionKind::kNumbers) return text;
    Json numbers = Json::parse("[" + text + "]", nullptr, /*allow_exceptions=*/false);
    if (numbers.is_discarded()) return text;
    return is_number ? Json(numbers.front()) : numbers;
  }
};

/// The kind and options requested for a pack.
Json askedOf(Job job) {
  OptionValues values;
  visitOptions(job, values);
  return {{"as", kindOf(job)}, {"options", std::move(values.json)}};
}

/// The members at the beginning of every report.
Json reportHead() { return {{"tool", "galactic-bake"}, {"version", GALACTIC_VERSION}}; }

/// How this run made the pack.
Json progressOf(const PackOutcome& pack) {
  Json json{{"pack", pack.name}, {"state", nameOf(pack.state)}, {"seconds", pack.seconds}};
  if (!pack.warnings.empty()) json["warnings"] = withFlags(pack.warnings);
  return json;
}

Json scenesOf(const std::vector<LeftOut>& scenes) {
  Json json = Json::array();
  for (const LeftOut& scene : scenes) {
    json.push_back({{"scene", scene.name}, {"reasons", withFlags(scene.reasons)}});
  }
  return json;
}

/// Adds what was requested for the world's packs, what was baked now or earlier, and what failed.
void addPacks(const WorldPlan& plan, const BuildOutcome& outcome, Json& json) {
  json["jobs"] = Json::array();
  for (const PackJob& pack : plan.assets) {
    json["jobs"].push_back(named("pack", pack.name, askedOf(pack.job)));
  }
  if (plan.episodes) {
    json["jobs"].push_back(named("pack", plan.episodes->name, askedOf(plan.episodes->job)));
  }
  json["baked"] = Json::array();
  json["failed"] = Json::array();
  for (const PackOutcome& pack : outcome.packs) {
    for (const Json& entry : pack.figures ? entriesOf(*pack.figures) : Json::array()) {
      Json one = named("pack", pack.name, entry);
      // A cached entry may have been made for another folder.
      one["output"] = (plan.folder / pack.name).string();
      json["baked"].push_back(std::move(one));
    }
    for (const BakeFailure& failure : pack.failures) {
      json["failed"].push_back(named("pack", pack.name, errorOf(failure)));
    }
  }
}

/// How this run went.
Json runOf(const BuildOutcome& outcome) {
  Json run{{"seconds", outcome.seconds}, {"stopped", outcome.stopped}};
  run["packs"] = Json::array();
  for (const PackOutcome& pack : outcome.packs) run["packs"].push_back(progressOf(pack));
  return run;
}

/// Sentences and the packs that they apply to, as many scenes lack the same things.
using Sentences = std::map<std::string, std::vector<std::string>>;

Sentences warningsOf(const BuildOutcome& outcome) {
  Sentences warnings;
  for (const PackOutcome& pack : outcome.packs) {
    std::vector<std::string> all = pack.warnings;
    if (pack.figures) std::ranges::copy(warningsOf(*pack.figures), std::back_inserter(all));
    for (const std::string& warning : all) warnings[warning].push_back(pack.name);
  }
  return warnings;
}

Sentences reasonsOf(const std::vector<LeftOut>& scenes) {
  Sentences reasons;
  for (const LeftOut& scene : scenes) {
    for (const std::string& reason : scene.reasons) reasons[reason].push_back(scene.name);
  }
  return reasons;
}

void print(const Sentences& sentences) {
  for (const auto& [sentence, of] : sentences) {
    const std::string more =
        of.size() > 1 ? fmt::format(" and {} more", of.size() - 1) : std::string();
    fmt::print("  {}{}: {}\n", printable(of.front()), more, printable(withFlags(sentence)));
  }
}

/// Prints the episodes that were made, now or earlier: what was drawn, and whether they can be
/// solved.
void printEpisodes(const BuildOutcome& outcome, Verbosity verbosity) {
  for (const PackOutcome& pack : outcome.packs) {
    if (!pack.figures) continue;
    const auto* set = std::get_if<EpisodeFigures>(&pack.figures->of);
    if (set == nullptr) continue;
    fmt::print("{}:\n", printable(pack.name));
    printEpisodes(*set, verbosity);
  }
}

void printWorld(const WorldPlan& plan, const BuildOutcome& outcome) {
  std::uint64_t bytes = 0;
  for (const LinkedPack& pack : outcome.linked) bytes += pack.bytes;
  fmt::print("{}, {:.2f} MB -> {}\n", counted(outcome.linked.size(), "pack"),
             static_cast<double>(bytes) / 1e6, plan.world.output.string());
}

}  // namespace

const char* nameOf(PackState state) {
  switch (state) {
    case PackState::kBaked:
      return "baked";
    case PackState::kUnchanged:
      return "unchanged";
    case PackState::kElsewhere:
      return "elsewhere";
    case PackState::kFailed:
      return "failed";
    case PackState::kPlanned:
      break;
  }
  return "planned";
}

Json reportOf(std::span<const PackJob> packs, const BuildOutcome& outcome) {
  Json json = reportHead();
  json["jobs"] = Json::array();
  for (const PackJob& pack : packs) {
    json["jobs"].push_back(named("output", pack.output.string(), askedOf(pack.job)));
  }
  json["baked"] = Json::array();
  json["failed"] = Json::array();
  for (const PackOutcome& pack : outcome.packs) {
    for (const Json& entry : pack.figures ? entriesOf(*pack.figures) : Json::array()) {
      json["baked"].push_back(entry);
    }
    for (const BakeFailure& failure : pack.failures) {
      json["failed"].push_back(named("input", failure.input.string(), errorOf(failure)));
    }
  }
  return json;
}

Json reportOf(const WorldPlan& plan, const BuildOutcome& outcome) {
  Json json = reportHead();
  json["output"] = plan.world.output.string();
  addPacks(plan, outcome, json);
  json["left_out"] = scenesOf(plan.left_out);
  json["warnings"] = withFlags(plan.warnings);
  // Left out if there are none, so that reports of worlds without a task stay the same.
  for (const OptionText& option : std::get<WorldJob>(plan.world.job).task) {
    json["task"][option.name] = option.value;
  }
  json["linked"] = Json::array();
  for (const LinkedPack& pack : outcome.linked) json["linked"].push_back(jsonOf(pack));
  json["run"] = runOf(outcome);
  return json;
}

Result<void> writeReport(const std::filesystem::path& path, const Json& report) {
  const std::string text = report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  return writeFileAtomically(path, text);
}

void printWorldTable(const WorldPlan& plan, const BuildOutcome& outcome, Verbosity verbosity) {
  printEpisodes(outcome, verbosity);
  if (!plan.left_out.empty()) {
    fmt::print("{} left out:\n", counted(plan.left_out.size(), "scene"));
    print(reasonsOf(plan.left_out));
  }
  if (plan.movable_objects > 0) {
    fmt::print("{} of the scenes: episodes alone place them\n",
               counted(plan.movable_objects, "movable object"));
  }
  const Sentences warnings = warningsOf(outcome);
  if (!warnings.empty() || !plan.warnings.empty()) fmt::print("warnings:\n");
  for (const std::string& warning : plan.warnings) {
    fmt::print("  {}\n", printable(withFlags(warning)));
  }
  print(warnings);
  fmt::print("{} baked, {} unchanged", outcome.count(PackState::kBaked),
             outcome.count(PackState::kUnchanged));
  for (const PackState state : {PackState::kFailed, PackState::kElsewhere, PackState::kPlanned}) {
    if (outcome.count(state) > 0) fmt::print(", {} {}", outcome.count(state), nameOf(state));
  }
  fmt::print("; {:.2f} s\n", outcome.seconds);
  if (!outcome.linked.empty()) printWorld(plan, outcome);
}

void printMissing(const std::vector<LeftOut>& missing) {
  if (missing.empty()) return fmt::print("nothing is missing\n");
  fmt::print("missing:\n");
  print(reasonsOf(missing));
}

Json missingReport(const std::vector<LeftOut>& missing) {
  Json json = Json::array();
  for (const LeftOut& pack : missing) {
    json.push_back({{"pack", pack.name}, {"reasons", withFlags(pack.reasons)}});
  }
  return json;
}

}  // namespace galactic::bake
