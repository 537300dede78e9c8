#include "galactic/bake/build.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <limits>
#include <set>
#include <utility>

#include "build/make_pack.h"
#include "galactic/bake/parallel_for.h"
#include "support/files/part_files.h"
#include "support/threads/stopwatch.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// Removes what killed builds of this pack left behind.
void removeLeftovers(const fs::path& pack) {
  (void)removeStaleParts(pack.parent_path(), {.target = pack.filename().string()});
}

/// A measure of how long a bake takes, only for comparison. A robot takes longest, however small
/// its meshes.
std::uint64_t effortOf(const PackJob& pack) {
  const bool is_robot = std::holds_alternative<RobotJob>(pack.job);
  return is_robot ? std::numeric_limits<std::uint64_t>::max() : pack.source_bytes;
}

/// The indices of this shard's assets, ascending.
std::vector<std::size_t> assetsOf(const WorldPlan& plan, const Shard& shard) {
  std::vector<std::size_t> assets;
  for (std::size_t n = shard.index; n < plan.assets.size(); n += shard.count) assets.push_back(n);
  return assets;
}

bool makesEpisodes(const WorldPlan& plan, const Shard& shard) {
  return plan.episodes && shard.count == 1;
}

class WorldBuild {
 public:
  WorldBuild(const WorldPlan& plan, const WorldBuildOptions& options, BuildObserver& observer,
             BakeLibraries& libraries)
      : plan_(plan),
        options_(options),
        tools_{.observer = observer,
               .libraries = libraries,
               .keep_going = options.keep_going,
               .memory = MemoryBudget(options.memory)},
        failed_(!plan.broken.empty()),
        outcome_(plannedOutcome(plan, options.shard)) {
    if (options.cache) tools_.cache.emplace(*options.cache);
  }

  BuildOutcome run() {
    {
      const detail::Stopwatch timer(outcome_.seconds);
      removeLeftoversOfAll();
      sayWhatIsBroken();
      bakeAssets();
      if (makesEpisodes(plan_, options_.shard)) bakeEpisodes();
      outcome_.stopped = tools_.observer.stops();
      if (linksWorld()) linkPacks();
    }
    return std::move(outcome_);
  }

 private:
  /// Removes only stale parts, because other shards may be working in the same folders.
  void removeLeftoversOfAll() const {
    if (tools_.cache) (void)removeStaleParts(tools_.cache->folder(), {.is_recursive = true});
    removeLeftovers(plan_.world.output);
    (void)removeStaleParts(plan_.folder, {.is_recursive = true});
  }

  void sayWhatIsBroken() {
    for (std::size_t n = 0; n < plan_.broken.size(); ++n) {
      tools_.observer.end(outcome_.packs[plan_.assets.size() + n]);
    }
  }

  void bakeAssets() {
    std::vector<std::size_t> order = assetsOf(plan_, options_.shard);
    if (order.empty()) return;
    // The longest bakes first.
    std::ranges::stable_sort(order, std::greater{},
                             [&](std::size_t n) { return effortOf(plan_.assets[n]); });
    const auto at_once =
        static_cast<unsigned>(std::min<std::size_t>(options_.threads, order.size()));
    const unsigned threads = (options_.threads + at_once - 1) / at_once;
    parallelFor(at_once, order.size(), [&](std::size_t k) {
      const PackJob& pack = plan_.assets[order[k]];
      if (!goesOn()) return;
      const MemoryBudget::Share share(tools_.memory, memoryFor(pack.source_bytes));
      outcome_.packs[order[k]] = makeOne(pack, threads);
    });
  }

  void bakeEpisodes() {
    PackJob episodes = *plan_.episodes;
    PackOutcome& outcome = outcome_.packs.back();
    const std::string failed = firstFailed();
    if (!goesOn()) return;
    if (!failed.empty() && !leaveOutFailed(episodes)) {
      const Error error{ErrorCode::kInvalidInput, episodes.output.string(),
                        "is not made, as " + failed + " is not there"};
      outcome.state = PackState::kFailed;
      outcome.failures.push_back({episodes.output, error});
      tools_.observer.end(outcome);
      return;
    }
    outcome = makeOne(episodes, options_.threads);
  }

  /// The name of the first asset that failed; empty if none did.
  [[nodiscard]] std::string firstFailed() const {
    const auto failed = std::ranges::find(outcome_.packs, PackState::kFailed, &PackOutcome::state);
    return failed == outcome_.packs.end() ? std::string() : failed->name;
  }

  /// Removes failed packs from those in which episodes are generated. Returns false if no episodes
  /// can be made without a failed pack: if it is the robot, or if the episodes are imported, as
  /// they may name any pack.
  [[nodiscard]] bool leaveOutFailed(PackJob& episodes) const {
    auto* generation = std::get_if<EpisodeGenerationJob>(&episodes.job);
    if (generation == nullptr) return false;
    for (std::size_t n = 0; n < plan_.assets.size(); ++n) {
      if (outcome_.packs[n].isThere()) continue;
      if (std::holds_alternative<RobotJob>(plan_.assets[n].job)) return false;
      std::erase(generation->packs, plan_.assets[n].output);
    }
    return true;
  }

  PackOutcome makeOne(const PackJob& pack, unsigned threads) {
    PackOutcome outcome = makePack(pack, threads, tools_);
    if (!outcome.failures.empty()) failed_ = true;
    return outcome;
  }

  /// Whether to link a world after this run.
  [[nodiscard]] bool linksWorld() const {
    if (options_.shard.count > 1 || outcome_.stopped) return false;
    return !failed_ ||
           (options_.keep_going && std::ranges::any_of(outcome_.packs, &PackOutcome::isThere));
  }

  void linkPacks() {
    std::set<fs::path> packs;
    for (const PackOutcome& pack : outcome_.packs) {
      if (pack.isThere()) packs.insert(plan_.folder / pack.name);
    }
    PackJob world = plan_.world;
    std::get<WorldJob>(world.job).packs.assign(packs.begin(), packs.end());
    outcome_.world = makeWorld(world, tools_, outcome_.linked);
  }

  [[nodiscard]] bool goesOn() {
    return !tools_.observer.stops() && (!failed_ || options_.keep_going);
  }

  const WorldPlan& plan_;
  const WorldBuildOptions& options_;
  BuildTools tools_;
  std::atomic<bool> failed_;
  BuildOutcome outcome_;
};

}  // namespace

std::size_t BuildOutcome::count(PackState state) const {
  return static_cast<std::size_t>(std::ranges::count(packs, state, &PackOutcome::state));
}

const Error* BuildOutcome::firstError() const {
  for (const PackOutcome& pack : packs) {
    if (!pack.failures.empty()) return &pack.failures.front().error;
  }
  return world && !world->failures.empty() ? &world->failures.front().error : nullptr;
}

BuildOutcome plannedOutcome(const WorldPlan& plan, const Shard& shard) {
  BuildOutcome outcome;
  for (const PackJob& pack : plan.assets) {
    outcome.packs.push_back({.name = pack.name, .state = PackState::kElsewhere});
  }
  for (const std::size_t n : assetsOf(plan, shard)) outcome.packs[n].state = PackState::kPlanned;
  for (const BrokenScene& scene : plan.broken) {
    outcome.packs.push_back(
        {.name = scene.name, .state = PackState::kFailed, .failures = {scene.failure}});
  }
  if (makesEpisodes(plan, shard)) outcome.packs.push_back({.name = plan.episodes->name});
  return outcome;
}

BuildOutcome build(std::span<const PackJob> packs, const BuildOptions& options,
                   BuildObserver& observer, BakeLibraries& libraries) {
  BuildTools tools{.observer = observer,
                   .libraries = libraries,
                   .keep_going = options.keep_going,
                   .dry_run = options.dry_run};
  BuildOutcome outcome;
  for (const PackJob& pack : packs) {
    if (!options.dry_run) removeLeftovers(pack.output);
    outcome.packs.push_back({.name = pack.name});
  }
  {
    const detail::Stopwatch timer(outcome.seconds);
    for (std::size_t n = 0; n < packs.size() && !observer.stops(); ++n) {
      outcome.packs[n] = makePack(packs[n], options.threads, tools);
      if (!outcome.packs[n].failures.empty() && !options.keep_going) break;
    }
  }
  outcome.stopped = observer.stops();
  return outcome;
}

BuildOutcome build(const WorldPlan& plan, const WorldBuildOptions& options, BuildObserver& observer,
                   BakeLibraries& libraries) {
  return WorldBuild(plan, options, observer, libraries).run();
}

}  // namespace galactic::bake
