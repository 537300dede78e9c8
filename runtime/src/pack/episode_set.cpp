#include "galactic/episode_set.h"

#include <cstddef>
#include <string>

#include "pack/schema_values.h"

namespace galactic {

static_assert(sizeof(Placement) == sizeof(schema::Placement));
static_assert(sizeof(Episode) == sizeof(schema::Episode));
static_assert(offsetof(Episode, base_position) == 16 && offsetof(Episode, goal) == 32);

Result<EpisodeSet> EpisodeSet::from(const PackFile& pack) {
  const schema::EpisodeSet* stored =
      pack.kind() == PackKind::kEpisodes ? pack.root().asset_as_EpisodeSet() : nullptr;
  if (stored == nullptr) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                "is a pack of kind " + packKindName(pack.kind()) +
                    ", expected episodes (EPIS); give the pack of an episode set");
  }
  EpisodeSet set;
  set.name_ = detail::fromSchema(stored->name());
  set.scenes_ = detail::namesOf(*stored->scenes());
  set.objects_ = detail::namesOf(*stored->objects());
  set.robot_ = detail::fromSchema(stored->robot());
  set.start_joints_ = detail::namesOf(*stored->start_joints());
  set.start_positions_ = detail::inPlace<float>(stored->start_positions());
  set.placements_ = detail::inPlace<Placement>(stored->placements());
  set.episodes_ = detail::inPlace<Episode>(stored->episodes());
  return set;
}

}  // namespace galactic
