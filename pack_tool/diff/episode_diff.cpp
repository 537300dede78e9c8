#include "pack_tool/diff/episode_diff.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "galactic/episode_set.h"
#include "support/text/counted.h"
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

/// The angle of the turn from one to the other, in double precision: it may be that of a last
/// digit.
double degreesBetween(const Quat& a, const Quat& b) {
  const auto wide = [](const Quat& q) {
    return std::array{static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z),
                      static_cast<double>(q.w)};
  };
  const auto p = wide(a);
  const auto q = wide(b);
  // The sine and the cosine of half the angle, as the parts of conjugate(a) * b.
  const double x = p[3] * q[0] - p[0] * q[3] - p[1] * q[2] + p[2] * q[1];
  const double y = p[3] * q[1] - p[1] * q[3] - p[2] * q[0] + p[0] * q[2];
  const double z = p[3] * q[2] - p[2] * q[3] - p[0] * q[1] + p[1] * q[0];
  const double w = p[3] * q[3] + p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
  return 2 * std::atan2(std::hypot(x, y, z), std::abs(w)) * 180 / std::numbers::pi;
}

/// What differs between the poses of the same objects.
struct Moves {
  std::size_t count = 0;
  bool is_elsewhere = false;
  bool is_turned = false;
  /// Meters, the most of all.
  double way = 0;
  /// Degrees, the most of all.
  double turn = 0;

  void add(const Pose& a, const Pose& b, double tolerance) {
    if (same(a, b, tolerance)) return;
    ++count;
    const Vec3 between = a.translation - b.translation;
    is_elsewhere = is_elsewhere || between != Vec3{};
    way = std::max(way, std::sqrt(static_cast<double>(dot(between, between))));
    const bool is_same_turn = same(Pose{{}, a.rotation}, Pose{{}, b.rotation}, 0);
    is_turned = is_turned || !is_same_turn;
    if (!is_same_turn) turn = std::max(turn, degreesBetween(a.rotation, b.rotation));
  }

  [[nodiscard]] std::string text() const {
    std::string ways;
    if (is_elsewhere) ways = fmt::format("up to {:.3g} m away", way);
    if (is_elsewhere && is_turned) ways += " and ";
    if (is_turned) ways += fmt::format("turned by up to {:.3g} degrees", turn);
    return fmt::format("{} {}: {}", count, count == 1 ? "differs" : "differ", ways);
  }
};

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
    Moves moves;
    for (std::size_t n = 0; n < placements.a.size(); ++n) {
      moves.add(placements.a[n].pose, placements.b[n].pose, tolerance_);
    }
    if (moves.count == 0) return;
    const std::string objects = counted(names_a.size(), "object");
    differences_.push_back({field, objects, fmt::format("{}, {}", objects, moves.text())});
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
