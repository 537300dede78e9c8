#include "plan/bake_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "bake_run.h"
#include "galactic/bake/world_pack.h"
#include "plan/make_plan.h"
#include "plan/plan_report.h"
#include "plan/plan_table.h"
#include "plan/run_plan.h"
#include "report_check.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

constexpr int kExitInterrupted = 130;

int listScenes(const BakeCommand& command) {
  const auto names = namesOfScenes(command);
  if (!names) return refuse(names.error());
  for (const std::string& name : *names) fmt::print("{}\n", name);
  return kExitOk;
}

bool isMade(const PackOutcome& pack) {
  return pack.state == PackState::kBaked || pack.state == PackState::kUnchanged;
}

/// The packs of the outcome in one world pack.
Result<std::vector<LinkedPack>> link(const WorldPlan& plan, const PlanOutcome& outcome) {
  std::set<fs::path> names;
  for (const PackOutcome& pack : outcome.packs) {
    if (!isMade(pack)) continue;
    names.insert(plan.folder / pack.name);
    if (!pack.entry) continue;
    for (const std::string& texture : texturePacks(*pack.entry))
      names.insert(plan.folder / texture);
  }
  const std::vector<fs::path> paths(names.begin(), names.end());
  auto packs = linkPacks(paths, plan.world.parent_path());
  // Of what the packs lack together, no one of them is the place.
  if (!packs && packs.error().where.empty()) packs.error().where = plan.world.string();
  if (!packs) return packs;
  std::vector<SourceFile> sources;
  sources.reserve(packs->size());
  for (const LinkedPack& pack : *packs) {
    sources.push_back({pack.path, pack.bytes, pack.hash_low, pack.hash_high});
  }
  BakeCommand linked;
  linked.remember("as", "world");
  const auto written =
      writeWorldPack(plan.world, *packs, provenanceOf(linked, std::move(sources), {}), plan.task);
  if (!written) return tl::unexpected(written.error());
  return packs;
}

/// Neither world nor report may replace what the command or one of its bakes reads.
Result<void> checkOutputs(const WorldPlan& plan, const BakeCommand& command) {
  const auto check = [&](const BakeCommand& reader) -> Result<void> {
    const BakeRun run(reader);
    if (auto checked = run.checkNotRead(plan.world); !checked) return checked;
    return run.checkNotRead(command.report);
  };
  if (auto checked = check(command); !checked) return checked;
  for (const PlannedPack& pack : plan.assets) {
    if (auto checked = check(pack.command); !checked) return checked;
  }
  return {};
}

/// Whether there is a world to link after this run.
bool linksWorld(const BakeCommand& command, const PlanOutcome& outcome) {
  if (command.dry_run || command.plan.shard.count > 1 || outcome.stopped) return false;
  return outcome.count(PackState::kFailed) == 0 ||
         (command.keep_going && std::any_of(outcome.packs.begin(), outcome.packs.end(), isMade));
}

int exitCodeOf(const PlanOutcome& outcome) {
  if (outcome.stopped) return kExitInterrupted;
  for (const PackOutcome& pack : outcome.packs) {
    if (pack.error) return static_cast<int>(pack.error->code);
  }
  return kExitOk;
}

/// Writes the report and compares it, where that is wanted.
int report(const PlanSummary& summary, std::optional<GoldenReport>& golden,
           const BakeCommand& command) {
  if (auto written = writePlanReport(summary, command); !written) return refuse(written.error());
  if (!golden) return kExitOk;
  Json made = planReport(summary);
  made.erase(kRunKey);
  golden->report.erase(kRunKey);
  return checkReport(*golden, made, command);
}

}  // namespace

int bakePlan(const BakeCommand& command) {
  if (command.dataset.list) return listScenes(command);
  const auto plan = makePlan(command);
  if (!plan) return refuse(plan.error());
  if (auto checked = checkOutputs(*plan, command); !checked) return refuse(checked.error());
  // Before anything is baked for a golden report that is not there.
  auto golden = goldenOf(command);
  if (!golden) return refuse(golden.error());
  const PlanOutcome outcome = runPlan(*plan, command);
  const int exit_code = exitCodeOf(outcome);
  PlanSummary summary{.plan = *plan, .outcome = outcome, .world = {}};
  if (linksWorld(command, outcome)) {
    auto packs = link(*plan, outcome);
    if (!packs) return refuse(packs.error());
    summary.world = std::move(*packs);
  }
  if (command.saysMore()) printPlanTable(summary);
  const int reported = report(summary, *golden, command);
  return exit_code == kExitOk ? reported : exit_code;
}

}  // namespace galactic::bake
