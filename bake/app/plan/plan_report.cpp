#include "plan/plan_report.h"

#include <fmt/format.h>

#include <span>
#include <string>

#include "galactic/atomic_file.h"

namespace galactic::bake {
namespace {

Json jsonOf(const PackOutcome& pack) {
  Json json{{"pack", pack.name}, {"state", nameOf(pack.state)}, {"seconds", pack.seconds}};
  if (pack.error) {
    json["code"] = static_cast<int>(pack.error->code);
    json["where"] = pack.error->where;
    json["message"] = pack.error->message;
  }
  if (!pack.entry.is_null()) json["bake"] = pack.entry;
  return json;
}

Json jsonOf(const LinkedPack& pack) {
  return {{"path", pack.path},
          {"kind", packKindName(pack.kind)},
          {"bytes", pack.bytes},
          {"xxh3_128", fmt::format("{:016x}{:016x}", pack.hash_high, pack.hash_low)}};
}

std::string jsonText(const PlanSummary& summary) {
  Json json{{"tool", "galactic-bake"}, {"version", GALACTIC_VERSION}};
  json["world"] = summary.plan.world.string();
  json["seconds"] = summary.outcome.seconds;
  json["stopped"] = summary.outcome.stopped;
  json["packs"] = Json::array();
  for (const PackOutcome& pack : summary.outcome.packs) json["packs"].push_back(jsonOf(pack));
  json["left_out"] = Json::array();
  for (const LeftOut& scene : summary.plan.left_out) {
    json["left_out"].push_back({{"scene", scene.name}, {"reasons", scene.reasons}});
  }
  json["warnings"] = summary.plan.warnings;
  json["linked"] = Json::array();
  for (const LinkedPack& pack : summary.world) json["linked"].push_back(jsonOf(pack));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

Result<void> writePlanReport(const PlanSummary& summary, const BakeCommand& command) {
  if (command.report.empty()) return {};
  const std::string text = jsonText(summary);
  return writeFileAtomically(command.report, {std::as_bytes(std::span(text))});
}

}  // namespace galactic::bake
