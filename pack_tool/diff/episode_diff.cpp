#include "pack_tool/diff/episode_diff.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "galactic/episode_set.h"
#include "support/try.h"

namespace galactic::pack_tool {

namespace {

/// What each side has of the same thing.
template <class T>
struct Both {
  T a;
  T b;
};

/// Numbers that belong together, for comparison and for text.
using Numbers = std::vector<float>;

Numbers numbersOf(const Vec3& v) { return {v.x, v.y, v.z}; }

/// Translation, then rotation in the order of text, (w, x, y, z).
Numbers numbersOf(const Pose& pose) {
  const Vec3& t = pose.translation;
  const Quat& q = pose.rotation;
  return {t.x, t.y, t.z, q.w, q.x, q.y, q.z};
}

bool same(const Numbers& a, const Numbers& b, double tolerance) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [tolerance](float x, float y) {
    return std::abs(static_cast<double>(x) - static_cast<double>(y)) <= tolerance;
  });
}

/// A quaternion and its negative are one rotation.
bool same(const Pose& a, const Pose& b, double tolerance) {
  const Quat& q = b.rotation;
  const Pose turned{b.translation, {-q.x, -q.y, -q.z, -q.w}};
  return same(numbersOf(a), numbersOf(b), tolerance) ||
         same(numbersOf(a), numbersOf(turned), tolerance);
}

/// Compares two episode sets, episode by episode.
class EpisodeComparison {
 public:
  EpisodeComparison(const EpisodeSet& a, const EpisodeSet& b, double tolerance)
      : a_(a), b_(b), tolerance_(tolerance) {}

  std::vector<FieldDifference> run() {
    const std::size_t both = std::min(a_.episodes().size(), b_.episodes().size());
    for (std::size_t n = 0; n < both; ++n) compareEpisode(n);
    return std::move(differences_);
  }

 private:
  void compareEpisode(std::size_t n) {
    prefix_ = fmt::format("episodes.{}", n);
    const Both<const Episode&> episode{a_.episodes()[n], b_.episodes()[n]};
    compareText("scene", a_.sceneNames().at(episode.a.scene), b_.sceneNames().at(episode.b.scene));
    compareNumbers("base_position", numbersOf(episode.a.base_position),
                   numbersOf(episode.b.base_position));
    compareNumbers("base_yaw", {episode.a.base_yaw}, {episode.b.base_yaw});
    if (a_.startJoints() == b_.startJoints()) {
      const auto start_a = a_.startPositions(n);
      const auto start_b = b_.startPositions(n);
      compareNumbers("start_positions", {start_a.begin(), start_a.end()},
                     {start_b.begin(), start_b.end()});
    }
    comparePlacements({a_.placements(episode.a), b_.placements(episode.b)});
    if (episode.a.target != episode.b.target) {
      differences_.push_back({prefix_ + ".target", std::to_string(episode.a.target),
                              std::to_string(episode.b.target)});
    }
    if (!same(episode.a.goal, episode.b.goal, tolerance_)) {
      compareNumbers("goal", numbersOf(episode.a.goal), numbersOf(episode.b.goal));
    }
  }

  void compareText(const char* field, std::string_view a, std::string_view b) {
    if (a == b) return;
    differences_.push_back({fmt::format("{}.{}", prefix_, field), std::string(a), std::string(b)});
  }

  void compareNumbers(const char* field, const Numbers& a, const Numbers& b) {
    if (same(a, b, tolerance_)) return;
    differences_.push_back({fmt::format("{}.{}", prefix_, field),
                            fmt::format("{}", fmt::join(a, ", ")),
                            fmt::format("{}", fmt::join(b, ", "))});
  }

  void comparePlacements(const Both<std::span<const Placement>>& placements) {
    const std::vector<std::string_view> names_a = namesOf(a_, placements.a);
    const std::vector<std::string_view> names_b = namesOf(b_, placements.b);
    const std::string field = prefix_ + ".placements";
    if (names_a != names_b) {
      differences_.push_back({field, fmt::format("{}", fmt::join(names_a, ", ")),
                              fmt::format("{}", fmt::join(names_b, ", "))});
      return;
    }
    std::size_t moved = 0;
    double farthest = 0;
    for (std::size_t n = 0; n < placements.a.size(); ++n) {
      const Pose& pose_a = placements.a[n].pose;
      const Pose& pose_b = placements.b[n].pose;
      if (same(pose_a, pose_b, tolerance_)) continue;
      ++moved;
      const Vec3 way = pose_a.translation - pose_b.translation;
      farthest = std::max(farthest, std::sqrt(static_cast<double>(dot(way, way))));
    }
    if (moved == 0) return;
    differences_.push_back(
        {field, fmt::format("{} objects", names_a.size()),
         fmt::format("{} objects, {} lie elsewhere, up to {:.3g} m away, or otherwise",
                     names_b.size(), moved, farthest)});
  }

  static std::vector<std::string_view> namesOf(const EpisodeSet& set,
                                               std::span<const Placement> placements) {
    std::vector<std::string_view> names;
    names.reserve(placements.size());
    for (const Placement& placement : placements) {
      names.push_back(set.objectNames().at(placement.object));
    }
    return names;
  }

  const EpisodeSet& a_;
  const EpisodeSet& b_;
  double tolerance_;
  std::string prefix_;
  std::vector<FieldDifference> differences_;
};

/// What a summary tells and the comparison of the episodes does not.
Json namesAndCounts(const Json& description) {
  const Json& set = description.at("episode_set");
  Json json;
  for (const char* key : {"name", "robot", "start_joints", "episode_count"}) {
    json[key] = set.at(key);
  }
  for (const char* key : {"scenes", "objects"}) {
    json[key] = Json::array();
    for (const Json& one : set.at(key)) {
      json[key].push_back({{"name", one.at("name")}, {"value", "present"}});
    }
  }
  return json;
}

}  // namespace

Result<void> compareEpisodes(const PackFile& a, const PackFile& b, const DiffOptions& options,
                             PackDifference& difference) {
  ASSIGN_OR_RETURN(const auto set_a, EpisodeSet::from(a));
  ASSIGN_OR_RETURN(const auto set_b, EpisodeSet::from(b));
  const Both<Json> descriptions{describePack(a, Detail::kSummary),
                                describePack(b, Detail::kSummary)};
  if (options.scope == DiffScope::kEverything) {
    difference.provenance =
        compareFields(descriptions.a.at("provenance"), descriptions.b.at("provenance"), 0);
  }
  Both<Json> names{namesAndCounts(descriptions.a), namesAndCounts(descriptions.b)};
  if (options.scope == DiffScope::kContent) {
    // The set's own name says which file it was; nothing is simulated by it.
    names.a.erase("name");
    names.b.erase("name");
  }
  difference.content = compareFields(names.a, names.b, 0);
  append(difference.content, EpisodeComparison(set_a, set_b, options.tolerance).run());
  return {};
}

}  // namespace galactic::pack_tool
