#include "episodes/episode_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
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

/// Splits episodes into batches.
std::vector<std::span<DrawnEpisode>> batchesOf(std::span<DrawnEpisode> episodes) {
  std::vector<std::span<DrawnEpisode>> batches;
  for (; !episodes.empty(); episodes = episodes.subspan(batches.back().size())) {
    batches.push_back(episodes.first(std::min(EpisodeBatch::kMost, episodes.size())));
  }
  return batches;
}

}  // namespace

/// A scene in progress, which is prepared when this is first needed.
class EpisodeDrawing::SceneWork {
 public:
  SceneWork(const GenerationContext& context, const SceneJournal& journal, const SceneOfPack& scene,
            SceneDetails details)
      : context_(context),
        journal_(journal),
        scene_(scene),
        details_(std::move(details)),
        key_(SceneJournal::keyOf(scene.scene.name(), details_)) {}

  [[nodiscard]] const SceneOfPack& scene() const { return scene_; }
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

Result<EpisodeDrawing::Outcome> EpisodeDrawing::run(std::vector<DealtScene> deal) {
  for (const DealtScene& dealt : deal) all_ += dealt.episodes.size();
  const unsigned threads = std::max(1U, inputs_.threads);
  const unsigned for_scenes = std::min(threads, scenesAtOnce(deal));
  std::vector<SceneResult> results(deal.size());
  parallelFor(for_scenes, deal.size(), [&](std::size_t n) {
    results[n] = runIn(std::move(deal[n]), std::max(1U, threads / for_scenes));
  });
  return outcomeOf(std::move(results));
}

/// How many scenes fit into memory at the same time. More threads than this would wait for their
/// turn, while they could help to draw in the scenes of others.
unsigned EpisodeDrawing::scenesAtOnce(std::span<const DealtScene> deal) const {
  std::uint64_t fitting = deal.size();
  if (inputs_.memory != nullptr) {
    std::uint64_t all = 0;
    for (const DealtScene& dealt : deal) all += memoryFor(dealt.scene->source_bytes);
    fitting = std::min(fitting, inputs_.memory->bytes() / (all / deal.size()));
  }
  return static_cast<unsigned>(std::max<std::uint64_t>(1, fitting));
}

EpisodeDrawing::SceneResult EpisodeDrawing::runIn(DealtScene dealt, unsigned threads) {
  std::optional<MemoryBudget::Share> share;
  if (inputs_.memory != nullptr) {
    share.emplace(*inputs_.memory, memoryFor(dealt.scene->source_bytes));
  }
  if (stateNow() >= State::kStopped) return {};
  ASSIGN_OR_RETURN(auto details, detailsOf(inputs_, *dealt.scene));
  SceneWork work(context_, journal_, *dealt.scene, std::move(details));
  auto look = work.look();
  if (!look) return tl::unexpected(noted(look.error()));
  const std::string name(dealt.scene->scene.name());
  if (!look->unusable.empty()) {
    goOnTo(State::kLooking);
    return UnusableScene{name, look->unusable};
  }
  if (state_ != State::kDrawing) return {};
  if (auto filled = fill(dealt.episodes, work, threads); !filled) {
    return Result<DrawnScene>(tl::unexpected(filled.error()));
  }
  GeneratedScene& summary = look->summary;
  const auto skipped = std::ranges::count(dealt.episodes, true, &DrawnEpisode::is_skipped);
  summary.name = name;
  summary.skipped = static_cast<std::uint32_t>(skipped);
  summary.episodes = static_cast<std::uint32_t>(dealt.episodes.size()) - summary.skipped;
  return Result<DrawnScene>(DrawnScene{std::move(summary), std::move(dealt.episodes)});
}

Result<void> EpisodeDrawing::fill(std::span<DrawnEpisode> episodes, SceneWork& work,
                                  unsigned threads) {
  std::vector<std::span<DrawnEpisode>> open = batchesOf(episodes);
  std::erase_if(open, [&](std::span<DrawnEpisode> batch) {
    const bool is_drawn = journal_.recall(work.key(), batch);
    if (is_drawn) count(batch.size());
    return is_drawn;
  });
  if (open.empty()) return {};
  ASSIGN_OR_RETURN(const PreparedScene* const prepared, work.prepared());
  const EpisodeBatch batch(context_, work.scene(), *prepared);
  std::vector<Result<void>> results(open.size());
  parallelFor(threads, open.size(), [&](std::size_t n) {
    if (stateNow() != State::kDrawing) return;
    results[n] = batch.fill(open[n]);
    if (!results[n]) return;
    if (auto added = journal_.add(work.key(), open[n]); added) {
      count(open[n].size());
    } else {
      results[n] = tl::unexpected(noted(added.error()));
    }
  });
  return firstFailure(results);
}

Result<EpisodeDrawing::Outcome> EpisodeDrawing::outcomeOf(std::vector<SceneResult> results) const {
  // All scenes are looked at, whatever happens in the others, so the first error is always the
  // same.
  for (const SceneResult& result : results) {
    if (!result) return tl::unexpected(result.error());
  }
  if (state_ == State::kStopped) {
    return fail(ErrorCode::kInterrupted, "episodes",
                fmt::format("interrupted after {} of {} episodes", done_, all_));
  }
  std::vector<UnusableScene> unusable;
  std::vector<DrawnScene> drawn;
  std::optional<Error> failure;
  for (SceneResult& result : results) {
    if (auto* scene = std::get_if<UnusableScene>(&*result)) {
      unusable.push_back(std::move(*scene));
    } else if (auto* tried = std::get_if<Result<DrawnScene>>(&*result)) {
      if (*tried) drawn.push_back(std::move(**tried));
      if (!*tried && !failure) failure = tried->error();
    }
  }
  // Besides an unusable scene, other errors depend on how far their scenes got: ignore them.
  if (!unusable.empty() && state_ != State::kFailed) return Outcome(std::move(unusable));
  if (failure) return tl::unexpected(std::move(*failure));
  return Outcome(std::move(drawn));
}

void EpisodeDrawing::goOnTo(State state) {
  State now = state_;
  while (now < state && !state_.compare_exchange_weak(now, state)) {
  }
}

EpisodeDrawing::State EpisodeDrawing::stateNow() {
  if (inputs_.stops && inputs_.stops()) goOnTo(State::kStopped);
  return state_;
}

Error EpisodeDrawing::noted(Error error) {
  if (error.code == ErrorCode::kIo) goOnTo(State::kFailed);
  return error;
}

void EpisodeDrawing::count(std::size_t episodes) {
  const std::lock_guard lock(mutex_);
  done_ += episodes;
  if (progress_) progress_(done_);
}

}  // namespace galactic::bake
