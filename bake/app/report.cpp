#include "report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <span>
#include <string>

#include "support/atomic_file.h"
#include "support/counted.h"
#include "support/printable.h"
#include "terminal.h"
#include "views.h"

namespace galactic::bake {
namespace {

/// The entries of a pack that was made, now or before. What is kept of it may have been made for
/// another folder.
Json entriesOf(const PackOutcome& pack, const JobList& list) {
  Json entries =
      reportEntries(*pack.figures, [](const std::string& sentence) { return withFlags(sentence); });
  if (!list.world) return entries;
  Json named = Json::array();
  for (const Json& entry : entries) {
    Json one{{"pack", pack.name}};
    one.update(entry);
    one["output"] = (list.folder / pack.name).string();
    named.push_back(std::move(one));
  }
  return named;
}

Json failureOf(const PackOutcome& pack, const BakeFailure& failure, const JobList& list) {
  Json json;
  if (list.world) {
    json["pack"] = pack.name;
  } else {
    json["input"] = failure.input.string();
  }
  json["code"] = static_cast<int>(failure.error.code);
  json["where"] = placeOf(failure.error);
  json["message"] = withFlags(failure.error.message);
  return json;
}

/// The options of a job that have a value, by name: numbers and switches as such, files without
/// their folders, and a list where there are several values.
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

/// What was asked for, one for each pack.
Json jobsOf(const JobList& list) {
  Json jobs = Json::array();
  const auto add = [&](const PackJob& pack) {
    Job job = pack.job;
    OptionValues values;
    visitOptions(job, values);
    Json one;
    if (list.world) {
      one["pack"] = pack.name;
    } else {
      one["output"] = pack.output.string();
    }
    one["as"] = kindOf(job);
    one["options"] = std::move(values.json);
    jobs.push_back(std::move(one));
  };
  for (const PackJob& pack : list.assets) add(pack);
  if (list.episodes) add(*list.episodes);
  return jobs;
}

/// How this run came to it.
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

void addWorld(const JobList& list, const BuildOutcome& outcome, Json& json) {
  json["left_out"] = scenesOf(list.left_out);
  json["warnings"] = withFlags(list.warnings);
  // Not where there are none: reports of before stay as they were.
  for (const OptionText& option : std::get<WorldJob>(list.world->job).task) {
    json["task"][option.name] = option.value;
  }
  json["linked"] = Json::array();
  for (const LinkedPack& pack : outcome.linked) json["linked"].push_back(jsonOf(pack));
  Json run{{"seconds", outcome.seconds}, {"stopped", outcome.stopped}};
  run["packs"] = Json::array();
  for (const PackOutcome& pack : outcome.packs) run["packs"].push_back(progressOf(pack));
  json["run"] = std::move(run);
}

/// Sentences, and of which packs they are said: many scenes lack the same things.
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

/// The episodes that were made, now or before: what was drawn, and whether they can be solved.
void printEpisodes(const BuildOutcome& outcome, Verbosity verbosity) {
  for (const PackOutcome& pack : outcome.packs) {
    if (!pack.figures) continue;
    const auto* set = std::get_if<EpisodeFigures>(&pack.figures->of);
    if (set == nullptr) continue;
    fmt::print("{}:\n", printable(pack.name));
    printEpisodes(*set, verbosity);
  }
}

void printWorld(const JobList& list, const BuildOutcome& outcome) {
  std::uint64_t bytes = 0;
  for (const LinkedPack& pack : outcome.linked) bytes += pack.bytes;
  fmt::print("{}, {:.2f} MB -> {}\n", counted(outcome.linked.size(), "pack"),
             static_cast<double>(bytes) / 1e6, list.world->output.string());
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

Json reportOf(const JobList& list, const BuildOutcome& outcome) {
  Json json{{"tool", "galactic-bake"}, {"version", GALACTIC_VERSION}};
  if (list.world) json["output"] = list.world->output.string();
  json["jobs"] = jobsOf(list);
  json["baked"] = Json::array();
  json["failed"] = Json::array();
  for (const PackOutcome& pack : outcome.packs) {
    if (pack.figures) {
      for (Json& entry : entriesOf(pack, list)) json["baked"].push_back(std::move(entry));
    }
    for (const BakeFailure& failure : pack.failures) {
      json["failed"].push_back(failureOf(pack, failure, list));
    }
  }
  if (list.world) addWorld(list, outcome, json);
  return json;
}

Result<void> writeReport(const std::filesystem::path& path, const Json& report) {
  const std::string text = report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  return writeFileAtomically(path, {std::as_bytes(std::span(text))});
}

void printWorldTable(const JobList& list, const BuildOutcome& outcome, Verbosity verbosity) {
  printEpisodes(outcome, verbosity);
  if (!list.left_out.empty()) {
    fmt::print("{} left out:\n", counted(list.left_out.size(), "scene"));
    print(reasonsOf(list.left_out));
  }
  const Sentences warnings = warningsOf(outcome);
  if (!warnings.empty() || !list.warnings.empty()) fmt::print("warnings:\n");
  for (const std::string& warning : list.warnings) {
    fmt::print("  {}\n", printable(withFlags(warning)));
  }
  print(warnings);
  fmt::print("{} baked, {} unchanged", outcome.count(PackState::kBaked),
             outcome.count(PackState::kUnchanged));
  for (const PackState state : {PackState::kFailed, PackState::kElsewhere, PackState::kPlanned}) {
    if (outcome.count(state) > 0) fmt::print(", {} {}", outcome.count(state), nameOf(state));
  }
  fmt::print("; {:.2f} s\n", outcome.seconds);
  if (!outcome.linked.empty()) printWorld(list, outcome);
  if (outcome.stopped) fmt::print("stopped; the same command goes on from here\n");
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
