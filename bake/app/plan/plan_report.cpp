#include "plan/plan_report.h"

#include <fmt/format.h>

#include <span>
#include <string>

#include "galactic/atomic_file.h"

namespace galactic::bake {
namespace {

/// What was baked, now or before, as the report of a single bake has it.
Json bakedOf(const PackOutcome& pack) {
  Json json{{"pack", pack.name}};
  json.update(*pack.entry);
  return json;
}

Json failureOf(const PackOutcome& pack) {
  return {{"pack", pack.name},
          {"code", static_cast<int>(pack.error->code)},
          {"where", pack.error->where},
          {"message", pack.error->message}};
}

/// How this run came to it.
Json progressOf(const PackOutcome& pack) {
  return {{"pack", pack.name}, {"state", nameOf(pack.state)}, {"seconds", pack.seconds}};
}

Json jsonOf(const LinkedPack& pack) {
  return {{"path", pack.path},
          {"kind", packKindName(pack.kind)},
          {"bytes", pack.bytes},
          {"xxh3_128", fmt::format("{:016x}{:016x}", pack.hash_high, pack.hash_low)}};
}

}  // namespace

Json planReport(const PlanSummary& summary) {
  Json json{{"tool", "galactic-bake"}, {"version", GALACTIC_VERSION}};
  json["output"] = summary.plan.world.string();
  json["baked"] = Json::array();
  json["failed"] = Json::array();
  Json run{{"seconds", summary.outcome.seconds}, {"stopped", summary.outcome.stopped}};
  run["packs"] = Json::array();
  for (const PackOutcome& pack : summary.outcome.packs) {
    if (pack.entry) json["baked"].push_back(bakedOf(pack));
    if (pack.error) json["failed"].push_back(failureOf(pack));
    run["packs"].push_back(progressOf(pack));
  }
  json["left_out"] = Json::array();
  for (const LeftOut& scene : summary.plan.left_out) {
    json["left_out"].push_back({{"scene", scene.name}, {"reasons", scene.reasons}});
  }
  json["warnings"] = summary.plan.warnings;
  // Not where there are none: reports of before stay as they were.
  for (const OptionText& option : summary.plan.task) json["task"][option.name] = option.value;
  json["linked"] = Json::array();
  for (const LinkedPack& pack : summary.world) json["linked"].push_back(jsonOf(pack));
  json[kRunKey] = std::move(run);
  return json;
}

Result<void> writePlanReport(const PlanSummary& summary, const BakeCommand& command) {
  if (command.report.empty()) return {};
  const std::string text =
      planReport(summary).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  return writeFileAtomically(command.report, {std::as_bytes(std::span(text))});
}

}  // namespace galactic::bake
