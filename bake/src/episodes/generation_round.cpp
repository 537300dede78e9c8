#include "episodes/generation_round.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "common/memory_budget.h"
#include "episodes/episode_batch.h"
#include "galactic/bake/parallel_for.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// The first failure in the order of `results`.
Result<void> firstFailure(std::span<const Result<void>> results) {
  for (const Result<void>& result : results) {
    if (!result) return result;
  }
  return {};
}

/// Cuts episodes into batches.
std::vector<std::span<DrawnEpisode>> batchesOf(std::span<DrawnEpisode> episodes) {
  std::vector<std::span<DrawnEpisode>> batches;
  for (; !episodes.empty(); episodes = episodes.subspan(batches.back().size())) {
    batches.push_back(episodes.first(std::min(EpisodeBatch::kMost, episodes.size())));
  }
  return batches;
}

}  // namespace

/// A scene at work, which is prepared when somebody needs that.
class GenerationRound::SceneWork {
 public:
  SceneWork(const GenerationContext& context, const SceneJournal& journal, const SceneOfPack& scene,
            SceneDetails details)
      : context_(context),
        journal_(journal),
        scene_(scene),
        details_(std::move(details)),
        key_(SceneJournal::keyOf(scene.scene.name(), details_)) {}

  [[nodiscard]] const SceneJournal::Key& key() const { return key_; }

  Result<SceneLook> look() {
    if (const SceneLook* known = journal_.lookAt(key_)) return *known;
    ASSIGN_OR_RETURN(const PreparedScene* const scene, prepared());
    SceneLook look{scene->unusable(), scene->summary()};
    RETURN_IF_ERROR(journal_.add(key_, look));
    return look;
  }

  Result<const PreparedScene*> prepared() {
    if (!prepared_) {
      ASSIGN_OR_RETURN(prepared_,
                       PreparedScene::prepare(context_, scene_.scene, std::move(details_)));
    }
    return prepared_.get();
  }

 private:
  const GenerationContext& context_;
  const SceneJournal& journal_;
  const SceneOfPack& scene_;
  SceneDetails details_;
  SceneJournal::Key key_;
  std::unique_ptr<const PreparedScene> prepared_;
};

Result<SceneDetails> detailsOf(const EpisodeInputs& inputs, const SceneOfPack& scene) {
  return inputs.details ? inputs.details(scene.scene.name()) : SceneDetails{};
}

void GenerationRound::run(std::vector<SceneTask>& tasks) {
  const unsigned jobs = std::max(1U, context_.options.jobs);
  const unsigned for_scenes = std::min(jobs, scenesAtOnce(tasks));
  parallelFor(for_scenes, tasks.size(),
              [&](std::size_t n) { runIn(tasks[n], std::max(1U, jobs / for_scenes)); });
}

/// How many scenes fit into memory together: more threads would wait for their turn instead of
/// drawing in the scenes of others.
unsigned GenerationRound::scenesAtOnce(std::span<const SceneTask> tasks) const {
  std::uint64_t fitting = tasks.size();
  if (inputs_.memory != nullptr) {
    std::uint64_t all = 0;
    for (const SceneTask& task : tasks) all += memoryFor(task.scene->source_bytes);
    fitting = std::min(fitting, inputs_.memory->bytes() / (all / tasks.size()));
  }
  return static_cast<unsigned>(std::max<std::uint64_t>(1, fitting));
}

/// Looks at the scene, draws its episodes with `jobs` threads, and forgets the scene.
void GenerationRound::runIn(SceneTask& task, unsigned jobs) {
  std::optional<MemoryBudget::Share> share;
  if (inputs_.memory != nullptr) {
    share.emplace(*inputs_.memory, memoryFor(task.scene->source_bytes));
  }
  if (stops()) return;
  auto details = detailsOf(inputs_, *task.scene);
  if (!details) {
    task.prepared = tl::unexpected(details.error());
    return;
  }
  SceneWork work(context_, journal_, *task.scene, std::move(*details));
  const auto look = work.look();
  if (!look) {
    task.prepared = kept(tl::unexpected(look.error()));
    return;
  }
  task.unusable = look->unusable;
  if (!task.unusable.empty()) only_look_ = true;
  if (only_look_) return;
  task.summary = look->summary;
  task.summary.name = std::string(task.scene->scene.name());
  task.drawn = draw(task, work, jobs);
  task.summary.skipped = static_cast<std::uint32_t>(
      std::ranges::count(task.episodes, true, &DrawnEpisode::is_skipped));
  task.summary.episodes = static_cast<std::uint32_t>(task.episodes.size()) - task.summary.skipped;
}

Result<void> GenerationRound::draw(SceneTask& task, SceneWork& work, unsigned jobs) {
  std::vector<std::span<DrawnEpisode>> open = batchesOf(task.episodes);
  std::erase_if(open, [&](std::span<DrawnEpisode> batch) {
    const bool is_drawn = journal_.recall(work.key(), batch);
    if (is_drawn) count(batch.size());
    return is_drawn;
  });
  if (open.empty()) return {};
  ASSIGN_OR_RETURN(const PreparedScene* const prepared, work.prepared());
  const EpisodeBatch batch(context_, *task.scene, *prepared);
  std::vector<Result<void>> results(open.size());
  parallelFor(jobs, open.size(), [&](std::size_t n) {
    if (only_look_ || stops()) return;
    results[n] = batch.fill(open[n]);
    if (results[n]) results[n] = kept(journal_.add(work.key(), open[n]));
    count(open[n].size());
  });
  return firstFailure(results);
}

bool GenerationRound::stops() {
  if (inputs_.stops && inputs_.stops()) is_stopped_ = true;
  return is_stopped_ || has_failed_;
}

Result<void> GenerationRound::kept(Result<void> added) {
  if (!added && added.error().code == ErrorCode::kIo) has_failed_ = true;
  return added;
}

void GenerationRound::count(std::size_t episodes) {
  if (!progress_) return;
  const std::lock_guard lock(mutex_);
  done_ += episodes;
  progress_(done_);
}

}  // namespace galactic::bake
