#include "galactic/bake/build.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <set>
#include <utility>

#include "build/make_pack.h"
#include "common/memory_budget.h"
#include "galactic/bake/parallel_for.h"
#include "support/part_files.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// How long a bake takes, for comparison only. A robot takes longest, however small its meshes.
std::uint64_t effortOf(const PackJob& pack) {
  const bool is_robot = std::holds_alternative<RobotJob>(pack.job);
  return is_robot ? std::numeric_limits<std::uint64_t>::max() : pack.source_bytes;
}

/// The indices of the assets that are this shard's, the longest first.
std::vector<std::size_t> orderOf(const JobList& list, const Shard& shard) {
  std::vector<std::size_t> order;
  for (std::size_t n = shard.index; n < list.assets.size(); n += shard.count) order.push_back(n);
  std::ranges::stable_sort(order, std::greater{},
                           [&](std::size_t n) { return effortOf(list.assets[n]); });
  return order;
}

class Build {
 public:
  Build(const JobList& list, const BuildOptions& options, BuildObserver& observer)
      : list_(list), options_(options), observer_(observer), budget_(options.memory) {
    if (options.cache) cache_.emplace(*options.cache);
    for (const PackJob& pack : list.assets) {
      outcome_.packs.push_back({.name = pack.name, .state = PackState::kElsewhere});
    }
    for (const BrokenScene& scene : list.broken) {
      outcome_.packs.push_back(
          {.name = scene.name, .state = PackState::kFailed, .failures = {scene.failure}});
      failed_ = true;
    }
  }

  BuildOutcome run() {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<std::size_t> order = orderOf(list_, options_.shard);
    for (const std::size_t n : order) outcome_.packs[n].state = PackState::kPlanned;
    if (options_.mode == BuildMode::kBake) removeLeftovers();
    sayWhatIsBroken();
    const bool has_episodes = list_.episodes && options_.shard.count == 1;
    if (options_.mode == BuildMode::kList) {
      if (has_episodes) outcome_.packs.push_back({.name = list_.episodes->name});
    } else {
      bakeAssets(order);
      if (has_episodes) bakeEpisodes();
    }
    outcome_.stopped = observer_.stops();
    outcome_.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (linksWorld()) linkPacksOfWorld();
    return std::move(outcome_);
  }

 private:
  /// Of builds that were killed: other shards may be at work in the same folders.
  void removeLeftovers() const {
    const auto clear = [](const fs::path& pack) {
      (void)removeStaleParts(pack.parent_path(), {.target = pack.filename().string()});
    };
    if (cache_) (void)removeStaleParts(cache_->folder(), {.is_recursive = true});
    if (!list_.world) {
      for (const PackJob& pack : list_.assets) clear(pack.output);
      return;
    }
    clear(list_.world->output);
    (void)removeStaleParts(list_.folder, {.is_recursive = true});
  }

  void sayWhatIsBroken() {
    for (std::size_t n = list_.assets.size(); n < outcome_.packs.size(); ++n) {
      const PackOutcome& broken = outcome_.packs[n];
      observer_.end({.name = broken.name, .job = SceneJob{}, .output = {}}, broken);
    }
  }

  void bakeAssets(const std::vector<std::size_t>& order) {
    if (order.empty()) return;
    const auto at_once = static_cast<unsigned>(
        std::min<std::size_t>({options_.jobs, order.size(), options_.at_once}));
    const unsigned jobs = (options_.jobs + at_once - 1) / at_once;
    parallelFor(at_once, order.size(), [&](std::size_t k) {
      const PackJob& pack = list_.assets[order[k]];
      if (!goesOn()) return;
      const MemoryBudget::Share share(budget_, memoryFor(pack.source_bytes));
      outcome_.packs[order[k]] = makeOne(pack, jobs);
    });
  }

  void bakeEpisodes() {
    PackJob episodes = *list_.episodes;
    const std::string failed = firstFailed();
    outcome_.packs.push_back({.name = episodes.name});
    if (!goesOn()) return;
    if (!failed.empty() && !leaveOutFailed(episodes)) {
      const Error error{ErrorCode::kInvalidInput, episodes.output.string(),
                        "is not made, as " + failed + " is not there"};
      outcome_.packs.back().state = PackState::kFailed;
      outcome_.packs.back().failures.push_back({episodes.output, error});
      observer_.end(episodes, outcome_.packs.back());
      return;
    }
    outcome_.packs.back() = makeOne(episodes, options_.jobs);
  }

  /// The name of an asset that failed; empty where none did.
  [[nodiscard]] std::string firstFailed() const {
    const auto failed = std::ranges::find(outcome_.packs, PackState::kFailed, &PackOutcome::state);
    return failed == outcome_.packs.end() ? std::string() : failed->name;
  }

  /// Leaves packs that failed out of those in which episodes are generated. False where something
  /// is left out without which there are none: the robot; and whatever imported episodes may name.
  [[nodiscard]] bool leaveOutFailed(PackJob& episodes) const {
    auto* generation = std::get_if<EpisodeGenerationJob>(&episodes.job);
    if (generation == nullptr) return false;
    for (std::size_t n = 0; n < list_.assets.size(); ++n) {
      if (outcome_.packs[n].isThere()) continue;
      if (std::holds_alternative<RobotJob>(list_.assets[n].job)) return false;
      std::erase(generation->packs, list_.assets[n].output);
    }
    return true;
  }

  PackOutcome makeOne(const PackJob& pack, unsigned jobs) {
    PackOutcome outcome = makePack(pack, jobs, tools());
    if (!outcome.failures.empty()) failed_ = true;
    return outcome;
  }

  /// Whether there is a world to link after this run.
  [[nodiscard]] bool linksWorld() const {
    if (!list_.world || options_.mode != BuildMode::kBake || options_.shard.count > 1) return false;
    if (outcome_.stopped) return false;
    return !failed_ ||
           (options_.keep_going && std::ranges::any_of(outcome_.packs, &PackOutcome::isThere));
  }

  void linkPacksOfWorld() {
    std::set<fs::path> packs;
    for (const PackOutcome& pack : outcome_.packs) {
      if (pack.isThere()) packs.insert(list_.folder / pack.name);
    }
    PackJob world = *list_.world;
    std::get<WorldJob>(world.job).packs.assign(packs.begin(), packs.end());
    outcome_.world = makeWorld(world, outcome_.linked, tools());
  }

  [[nodiscard]] BuildTools tools() {
    return {.observer = observer_,
            .cache = cache_ ? &*cache_ : nullptr,
            .digests = digests_,
            .textures = textures_,
            .memory = budget_,
            .options = options_};
  }
  [[nodiscard]] bool goesOn() { return !observer_.stops() && (!failed_ || options_.keep_going); }

  const JobList& list_;
  const BuildOptions& options_;
  BuildObserver& observer_;
  MemoryBudget budget_;
  FileDigests digests_;
  TextureChecks textures_;
  std::optional<BakeCache> cache_;
  std::atomic<bool> failed_{false};
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

BuildOutcome build(const JobList& list, const BuildOptions& options, BuildObserver& observer) {
  return Build(list, options, observer).run();
}

}  // namespace galactic::bake
