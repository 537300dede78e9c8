#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "check/asset_checks.h"
#include "check/common_check.h"
#include "check/offence.h"

namespace galactic::detail {
namespace {

using Names = flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>;

/// Checks an episode set part by part. Episodes and placements are the bulk of a pack: they are
/// checked in bulk, and only the first offender is examined for a message.
class EpisodeChecker {
 public:
  EpisodeChecker(const schema::EpisodeSet& set, const std::string& where)
      : set_(set), offence_(where + ": episode_set") {}

  Result<void> run() {
    offence_.require(!isEmpty(set_.name()), "name", "is empty, expected the episodes' name");
    checkAscending(*set_.scenes(), "scenes", "scene");
    checkAscending(*set_.objects(), "objects", "object");
    checkJoints();
    offence_.require(episodes() >= 1, "episodes", "is empty, expected at least one episode");
    checkStartPositions();
    checkPlacements();
    checkEpisodes();
    return offence_.result();
  }

 private:
  [[nodiscard]] std::size_t episodes() const { return set_.episodes()->size(); }
  [[nodiscard]] std::size_t placements() const { return set_.placements()->size(); }

  void checkAscending(const Names& names, const char* field, const char* owner) {
    offence_.require(names.size() >= 1, field, "is empty, expected at least one {}", owner);
    for (flatbuffers::uoffset_t n = 0; n < names.size() && !offence_.found(); ++n) {
      const std::string element = fmt::format("{}[{}]", field, n);
      offence_.require(!isEmpty(names.Get(n)), element, "is empty, expected the {}'s name", owner);
      if (n == 0) continue;
      offence_.require(names.Get(n - 1)->string_view() < names.Get(n)->string_view(), element,
                       "does not come after its predecessor, expected ascending names");
    }
  }

  void checkJoints() {
    const Names& names = *set_.start_joints();
    std::set<std::string_view> seen;
    for (flatbuffers::uoffset_t n = 0; n < names.size() && !offence_.found(); ++n) {
      const std::string_view name = names.Get(n)->string_view();
      offence_.require(!name.empty() && seen.insert(name).second,
                       fmt::format("start_joints[{}]", n),
                       "is empty or a repeated name, expected each joint's own");
    }
  }

  void checkStartPositions() {
    const auto& positions = *set_.start_positions();
    const std::uint64_t wanted = std::uint64_t{episodes()} * set_.start_joints()->size();
    offence_.require(positions.size() == wanted, "start_positions",
                     "has {} elements, expected {}, one per episode and start joint",
                     positions.size(), wanted);
    const auto broken = std::find_if(positions.begin(), positions.end(),
                                     [](float position) { return !isAngle(position); });
    if (broken == positions.end()) return;
    offence_.require(false, fmt::format("start_positions[{}]", broken - positions.begin()),
                     "is {}, expected a position of up to {}", *broken, kMostAngle);
  }

  void checkPlacements() {
    const auto& stored = *set_.placements();
    const std::size_t objects = set_.objects()->size();
    const auto broken =
        std::find_if(stored.begin(), stored.end(), [objects](const schema::Placement* placement) {
          return placement->object() >= objects || !isRigid(placement->pose());
        });
    if (broken == stored.end()) return;
    const std::string field = fmt::format("placements[{}]", broken - stored.begin());
    offence_.require((*broken)->object() < objects, field + ".object",
                     "is {}, expected one of {} objects", (*broken)->object(), objects);
    offence_.require(isRigid((*broken)->pose()), field + ".pose",
                     "is not a rigid transform, expected up to {} m and a unit quaternion",
                     kFarthest);
  }

  void checkEpisodes() {
    std::size_t next_placement = 0;
    for (flatbuffers::uoffset_t n = 0; n < episodes() && !offence_.found(); ++n) {
      const schema::Episode& episode = *set_.episodes()->Get(n);
      if (!isSound(episode, next_placement)) {
        requireSound(episode, next_placement, fmt::format("episodes[{}]", n));
      }
      next_placement += episode.placement_count();
    }
    offence_.require(next_placement == placements(), "placements",
                     "has {} elements, expected the {} that the episodes name", placements(),
                     next_placement);
  }

  [[nodiscard]] bool ownsRange(const schema::Episode& episode, std::size_t next_placement) const {
    return episode.first_placement() == next_placement && episode.placement_count() >= 1 &&
           episode.placement_count() <= placements() - next_placement;
  }

  [[nodiscard]] bool isSound(const schema::Episode& episode, std::size_t next_placement) const {
    return episode.scene() < set_.scenes()->size() && ownsRange(episode, next_placement) &&
           episode.target() < episode.placement_count() && isPlace(episode.base_position()) &&
           isAngle(episode.base_yaw()) && isRigid(episode.goal());
  }

  void requireSound(const schema::Episode& episode, std::size_t next_placement,
                    const std::string& field) {
    offence_.require(episode.scene() < set_.scenes()->size(), field + ".scene",
                     "is {}, expected one of {} scenes", episode.scene(), set_.scenes()->size());
    offence_.require(ownsRange(episode, next_placement), field + ".first_placement",
                     "and count are {} and {}, expected {} and 1 to {}", episode.first_placement(),
                     episode.placement_count(), next_placement, placements() - next_placement);
    offence_.require(episode.target() < episode.placement_count(), field + ".target",
                     "is {}, expected one of the episode's {} placements", episode.target(),
                     episode.placement_count());
    offence_.require(isPlace(episode.base_position()), field + ".base_position",
                     "is farther than {} m or not finite, expected coordinates", kFarthest);
    offence_.require(isAngle(episode.base_yaw()), field + ".base_yaw",
                     "is {} rad, expected an angle of up to {} rad", episode.base_yaw(),
                     kMostAngle);
    offence_.require(isRigid(episode.goal()), field + ".goal",
                     "is not a rigid transform, expected up to {} m and a unit quaternion",
                     kFarthest);
  }

  const schema::EpisodeSet& set_;
  Offence offence_;
};

}  // namespace

Result<void> checkEpisodeSet(const schema::EpisodeSet& set, const std::string& where) {
  return EpisodeChecker(set, where).run();
}

}  // namespace galactic::detail
