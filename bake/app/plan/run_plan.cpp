#include "plan/run_plan.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>

#include "galactic/bake/parallel_for.h"
#include "galactic/part_files.h"
#include "plan/bake_planned.h"
#include "plan/memory_budget.h"
#include "plan/plan_progress.h"
#include "plan/stop_request.h"

namespace galactic::bake {
namespace {

/// What a bake takes, as measured on meshes of 0.1 to 60 MB: geometry, textures and grids.
std::uint64_t memoryOf(const PlannedPack& pack) {
  constexpr std::uint64_t kAtLeast = std::uint64_t{64} << 20U;
  constexpr std::uint64_t kPerByte = 12;
  return kAtLeast + kPerByte * pack.source_bytes;
}

/// How long a bake takes, for comparison only. A robot takes longest, and its URDF says nothing of
/// its meshes.
std::uint64_t effortOf(const PlannedPack& pack) {
  const bool is_robot = pack.command.kind == AssetKind::kRobot;
  return is_robot ? std::numeric_limits<std::uint64_t>::max() : pack.source_bytes;
}

/// The indices of the assets that are this shard's, the longest first.
std::vector<std::size_t> orderOf(const WorldPlan& plan, const Shard& shard) {
  std::vector<std::size_t> order;
  for (std::size_t n = shard.index; n < plan.assets.size(); n += shard.count) order.push_back(n);
  std::ranges::stable_sort(order, std::greater{},
                           [&](std::size_t n) { return effortOf(plan.assets[n]); });
  return order;
}

class PlanRun {
 public:
  PlanRun(const WorldPlan& plan, const BakeCommand& command)
      : plan_(plan), command_(command), budget_(command.plan.memory) {
    if (!command.plan.no_cache) {
      cache_.emplace(command.plan.cache.empty() ? plan.folder / ".cache" : command.plan.cache);
    }
    for (const PlannedPack& pack : plan.assets) {
      outcome_.packs.push_back({.name = pack.name, .state = PackState::kElsewhere});
    }
  }

  PlanOutcome run() {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<std::size_t> order = orderOf(plan_, command_.plan.shard);
    const bool with_episodes = plan_.episodes && command_.plan.shard.count == 1;
    PlanProgress progress(order.size() + (with_episodes ? 1 : 0), command_.verbosity);
    for (const std::size_t n : order) outcome_.packs[n].state = PackState::kPlanned;
    if (!command_.dry_run) {
      removeLeftovers();
      bakeAssets(order, progress);
      if (with_episodes) bakeEpisodes(progress);
    }
    outcome_.stopped = stop_.came();
    outcome_.seconds = secondsSince(start);
    return std::move(outcome_);
  }

 private:
  /// Of runs that were killed: other shards may be at work in the same folders.
  void removeLeftovers() const {
    (void)removeStaleParts(plan_.world.parent_path(), {.target = plan_.world.filename().string()});
    (void)removeStaleParts(plan_.folder, {.is_recursive = true});
    if (cache_) (void)removeStaleParts(cache_->folder(), {.is_recursive = true});
  }

  void bakeAssets(const std::vector<std::size_t>& order, PlanProgress& progress) {
    if (order.empty()) return;
    const auto at_once = static_cast<unsigned>(std::min<std::size_t>(command_.jobs, order.size()));
    const unsigned jobs = (command_.jobs + at_once - 1) / at_once;
    parallelFor(at_once, order.size(), [&](std::size_t k) {
      const PlannedPack& pack = plan_.assets[order[k]];
      if (!goesOn()) return;
      budget_.take(memoryOf(pack));
      outcome_.packs[order[k]] = bakeOne(pack, jobs, progress);
      budget_.giveBack(memoryOf(pack));
    });
  }

  void bakeEpisodes(PlanProgress& progress) {
    outcome_.packs.push_back({.name = plan_.episodes->name});
    // Of assets that failed there is no pack to make episodes in.
    const bool complete =
        std::all_of(outcome_.packs.begin(), outcome_.packs.end() - 1, [](const PackOutcome& pack) {
          return pack.state == PackState::kBaked || pack.state == PackState::kUnchanged;
        });
    if (complete && goesOn()) {
      outcome_.packs.back() = bakeOne(*plan_.episodes, command_.jobs, progress);
    }
  }

  PackOutcome bakeOne(const PlannedPack& pack, unsigned jobs, PlanProgress& progress) {
    progress.begin(pack.name);
    const PlanTools tools{.cache = cache_ ? &*cache_ : nullptr,
                          .digests = digests_,
                          .textures = textures_,
                          .jobs = jobs};
    PackOutcome outcome = bakePlanned(pack, tools);
    if (outcome.state == PackState::kFailed) failed_ = true;
    progress.end(outcome);
    return outcome;
  }

  [[nodiscard]] bool goesOn() const { return !stop_.came() && (!failed_ || command_.keep_going); }

  const WorldPlan& plan_;
  const BakeCommand& command_;
  StopRequest stop_;
  MemoryBudget budget_;
  FileDigests digests_;
  TextureChecks textures_;
  std::optional<BakeCache> cache_;
  std::atomic<bool> failed_{false};
  PlanOutcome outcome_;
};

}  // namespace

PlanOutcome runPlan(const WorldPlan& plan, const BakeCommand& command) {
  return PlanRun(plan, command).run();
}

}  // namespace galactic::bake
