#include "episodes/episode_batch.h"

#include <cstdint>

#include "common/random.h"
#include "episodes/trial/episode_replay.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// Numbers of drafts of one episode: up to the first number places are drawn anywhere, up to the
/// second near places that are known to hold objects, and up to the last with fewer objects if need
/// be. After that the episode is skipped.
constexpr std::uint32_t kDraftsAnywhere = 50;
constexpr std::uint32_t kDraftsWithAll = 100;
constexpr std::uint32_t kDrafts = 150;

}  // namespace

struct EpisodeBatch::Pending {
  DrawnEpisode* drawn;
  Random random;
  DraftedEpisode draft{};
  bool is_done = false;
};

EpisodeBatch::EpisodeBatch(const GenerationContext& context, const SceneOfPack& scene,
                           const PreparedScene& prepared)
    : context_(context),
      scene_(scene),
      home_(prepared.draftHome()),
      packs_(context.world.commonPacks()),
      proven_(prepared.provenPairs()) {
  packs_.push_back(scene.pack);
}

Result<void> EpisodeBatch::fill(std::span<DrawnEpisode> episodes) const {
  std::vector<Pending> pending;
  pending.reserve(episodes.size());
  std::vector<Pending*> open;
  open.reserve(episodes.size());
  for (DrawnEpisode& episode : episodes) {
    open.push_back(&pending.emplace_back(Pending{&episode, Random(episode.seed)}));
  }
  while (!open.empty()) {
    for (Pending* one : open) draw(*one);
    std::erase_if(open, [](const Pending* one) { return one->drawn->is_skipped; });
    if (open.empty()) break;
    if (auto replayed = replay(open); !replayed) return replayed;
    std::erase_if(open, [](const Pending* one) { return one->is_done; });
  }
  return {};
}

void EpisodeBatch::draw(Pending& pending) const {
  DrawnEpisode& drawn = *pending.drawn;
  while (drawn.drafts < kDrafts) {
    DraftEase ease;
    if (drawn.drafts >= kDraftsAnywhere) ease.proven = proven_;
    ease.may_lack_objects = drawn.drafts >= kDraftsWithAll;
    ++drawn.drafts;
    const DraftEnd end = draftEpisode(home_, ease, pending.random, pending.draft, drawn.rejections);
    ++drawn.ends[static_cast<std::size_t>(end)];
    if (end != DraftEnd::kDone) continue;
    setDraft(pending.draft, drawn);
    return;
  }
  drawn.is_skipped = true;
}

Result<void> EpisodeBatch::replay(std::span<Pending* const> open) const {
  const SceneOfPack* const scene = &scene_;
  SourceEpisodes set = emptySet(context_.world, {&scene, 1});
  set.episodes.reserve(open.size());
  for (const Pending* one : open) append(*one->drawn, 0, set);
  ASSIGN_OR_RETURN(const auto ends, replayEpisodes(packs_, set));
  for (std::size_t n = 0; n < open.size(); ++n) {
    Pending& one = *open[n];
    one.is_done = ends[n] == ReplayEnd::kStands;
    if (one.is_done) continue;
    ++one.drawn->replays_failed;
    one.drawn->rejections.add(ends[n] == ReplayEnd::kBlocked ? EpisodeRejection::kReplayBlocked
                                                             : EpisodeRejection::kReplayMoved);
  }
  return {};
}

}  // namespace galactic::bake
