#include "plan/plan_table.h"

#include <fmt/format.h>

#include <map>

#include "galactic/printable.h"

namespace galactic::bake {
namespace {

/// Sentences, and of which packs they are said: many scenes lack the same things.
using Sentences = std::map<std::string, std::vector<std::string>>;

Sentences warningsOf(const PlanOutcome& outcome) {
  Sentences warnings;
  for (const PackOutcome& pack : outcome.packs) {
    if (!pack.entry || !pack.entry->contains("warnings")) continue;
    for (const Json& warning : pack.entry->at("warnings")) {
      warnings[warning.get<std::string>()].push_back(pack.name);
    }
  }
  return warnings;
}

Sentences reasonsOf(const WorldPlan& plan) {
  Sentences reasons;
  for (const LeftOut& scene : plan.left_out) {
    for (const std::string& reason : scene.reasons) reasons[reason].push_back(scene.name);
  }
  return reasons;
}

void print(const Sentences& sentences) {
  for (const auto& [sentence, of] : sentences) {
    const std::string more =
        of.size() > 1 ? fmt::format(" and {} more", of.size() - 1) : std::string();
    fmt::print("  {}{}: {}\n", printable(of.front()), more, printable(sentence));
  }
}

void printWorld(const PlanSummary& summary) {
  std::uint64_t bytes = 0;
  for (const LinkedPack& pack : summary.world) bytes += pack.bytes;
  fmt::print("{} packs, {:.2f} MB -> {}\n", summary.world.size(), static_cast<double>(bytes) / 1e6,
             summary.plan.world.string());
}

}  // namespace

void printPlanTable(const PlanSummary& summary) {
  const PlanOutcome& outcome = summary.outcome;
  if (!summary.plan.left_out.empty()) {
    fmt::print("{} scenes are left out:\n", summary.plan.left_out.size());
    print(reasonsOf(summary.plan));
  }
  const Sentences warnings = warningsOf(outcome);
  if (!warnings.empty() || !summary.plan.warnings.empty()) fmt::print("warnings:\n");
  for (const std::string& warning : summary.plan.warnings) {
    fmt::print("  {}\n", printable(warning));
  }
  print(warnings);
  fmt::print("{} baked, {} unchanged", outcome.count(PackState::kBaked),
             outcome.count(PackState::kUnchanged));
  for (const PackState state : {PackState::kFailed, PackState::kElsewhere, PackState::kPlanned}) {
    if (outcome.count(state) > 0) fmt::print(", {} {}", outcome.count(state), nameOf(state));
  }
  fmt::print("; {:.2f} s\n", outcome.seconds);
  if (!summary.world.empty()) printWorld(summary);
  if (outcome.stopped) fmt::print("stopped; the same command goes on from here\n");
}

}  // namespace galactic::bake
