#include "episodes/scene_journal.h"

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "import/transfer_archive.h"

namespace galactic::bake {

template <class Archive>
void transferFields(Archive& archive, Is<GeneratedScene> auto& scene) {
  // 0 if there is none.
  float shortened_way = scene.shortened_way.value_or(0);
  archive(scene.name, scene.floor_places, scene.floor_parts, scene.support_places, scene.surfaces,
          scene.bumpy_places, scene.receptacles, scene.has_mesh, shortened_way);
  if constexpr (!std::is_const_v<std::remove_reference_t<decltype(scene)>>) {
    if (shortened_way > 0) scene.shortened_way = shortened_way;
  }
}

template <class Archive>
void transferFields(Archive& archive, Is<SceneLook> auto& look) {
  archive(look.unusable, look.summary);
}

template <class Archive>
void transferFields(Archive& archive, Is<DrawnEpisode> auto& one) {
  archive(one.number, one.seed, one.is_skipped, one.drafts, one.replays_failed, one.ends,
          one.rejections, one.episode, one.placements);
}

template <class Archive>
void transferFields(Archive& archive, Is<SupportRegion> auto& region) {
  archive(region.name, region.world_from_region, region.half_extents);
}

namespace {

enum class RecordKind : std::uint8_t { kLook, kBatch };

/// Whether a recorded episode fits the generation; the journal may come from anywhere.
bool isSound(const DrawnEpisode& episode, std::size_t objects) {
  if (episode.is_skipped) return true;
  return episode.episode.placement_count == episode.placements.size() &&
         episode.episode.target < episode.placements.size() &&
         std::ranges::all_of(episode.placements,
                             [&](const Placement& one) { return one.object < objects; });
}

}  // namespace

SceneJournal::Key SceneJournal::keyOf(std::string_view scene, const SceneDetails& details) {
  const auto hash_of = [](const auto& list) {
    return detail::contentHash(std::as_bytes(std::span(list)));
  };
  // Hashes the meshes separately, because they are too large to copy.
  return hash_of(bytesOf(scene, hash_of(details.mesh.vertices), hash_of(details.mesh.triangles),
                         details.receptacles));
}

SceneJournal::SceneJournal(Journal* journal, std::size_t objects)
    : journal_(journal), objects_(objects) {
  if (journal_ == nullptr) return;
  for (const std::string_view record : journal_->records()) read(record);
}

void SceneJournal::read(std::string_view record) {
  TransferReader reader(std::as_bytes(std::span(record)));
  RecordKind kind{};
  Key key;
  reader(kind, key);
  const Name name{key.high, key.low};
  if (kind == RecordKind::kLook) {
    SceneLook look;
    reader(look);
    if (reader.good() && reader.atEnd()) looks_.insert_or_assign(name, std::move(look));
    return;
  }
  std::vector<DrawnEpisode> batch;
  reader(batch);
  const bool is_whole = reader.good() && reader.atEnd() && !batch.empty();
  const auto is_sound = [&](const DrawnEpisode& one) { return isSound(one, objects_); };
  if (!is_whole || !std::ranges::all_of(batch, is_sound)) return;
  const std::size_t first = batch.front().number;
  batches_.insert_or_assign({name, first}, std::move(batch));
}

bool SceneJournal::hasUnusable(std::string_view scene) const {
  return std::ranges::any_of(looks_, [&](const auto& one) {
    return !one.second.unusable.empty() && one.second.summary.name == scene;
  });
}

const SceneLook* SceneJournal::lookAt(const Key& key) const {
  const auto found = looks_.find({key.high, key.low});
  return found == looks_.end() ? nullptr : &found->second;
}

bool SceneJournal::recall(const Key& key, std::span<DrawnEpisode> episodes) const {
  const auto found = batches_.find({{key.high, key.low}, episodes.front().number});
  if (found == batches_.end()) return false;
  const std::vector<DrawnEpisode>& drawn = found->second;
  const auto is_same = [](const DrawnEpisode& a, const DrawnEpisode& b) {
    return a.number == b.number && a.seed == b.seed;
  };
  if (!std::ranges::equal(drawn, episodes, is_same)) return false;
  std::ranges::copy(drawn, episodes.begin());
  return true;
}

Result<void> SceneJournal::add(const Key& key, const SceneLook& look) const {
  if (journal_ == nullptr) return {};
  return journal_->add(bytesOf(RecordKind::kLook, key, look));
}

Result<void> SceneJournal::add(const Key& key, std::span<const DrawnEpisode> episodes) const {
  if (journal_ == nullptr) return {};
  const std::vector<DrawnEpisode> batch(episodes.begin(), episodes.end());
  return journal_->add(bytesOf(RecordKind::kBatch, key, batch));
}

}  // namespace galactic::bake
