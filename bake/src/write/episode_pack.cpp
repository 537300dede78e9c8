#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>

#include "galactic/bake/packs.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/try.h"
#include "write/pack_payload.h"

namespace galactic::bake {
namespace {

/// More than the effect of rounding to floats on a length of 1.
constexpr double kUnitTolerance = 5e-4;

/// Limit of the angles and joint positions that readers of packs accept.
constexpr float kMostAngle = 1e9F;

bool isPlace(const Vec3& v) {
  constexpr auto kFarthest = static_cast<float>(kMaxCoordinate);
  return std::fabs(v.x) <= kFarthest && std::fabs(v.y) <= kFarthest && std::fabs(v.z) <= kFarthest;
}

bool isAngle(float radians) { return std::fabs(radians) <= kMostAngle; }

bool isRigid(const Pose& pose) {
  const auto square = [](float value) {
    return static_cast<double>(value) * static_cast<double>(value);
  };
  const Quat& q = pose.rotation;
  const double length = std::sqrt(square(q.x) + square(q.y) + square(q.z) + square(q.w));
  return isPlace(pose.translation) && std::abs(length - 1) <= kUnitTolerance;
}

/// Checks episodes against the schema's requirements; keeps the first error.
class EpisodeCheck {
 public:
  explicit EpisodeCheck(const SourceEpisodes& source) : source_(source) {}

  Result<void> run() {
    require(!source_.name.empty(), "name", "is empty, expected the episodes' name");
    checkAscending(source_.scenes, "scenes");
    checkAscending(source_.objects, "objects");
    checkJoints();
    require(!source_.episodes.empty(), "episodes", "is empty, expected at least one episode");
    for (std::size_t n = 0; n < source_.placements.size() && result_; ++n) checkPlacement(n);
    std::size_t next = 0;
    for (std::size_t n = 0; n < source_.episodes.size() && result_; ++n) {
      checkEpisode(n, next);
      next += source_.episodes[n].placement_count;
    }
    require(next == source_.placements.size(), "placements",
            "has elements that belong to no episode; leave them out");
    return result_;
  }

 private:
  void require(bool holds, const std::string& where, const std::string& message) {
    if (holds || !result_) return;
    result_ = fail(ErrorCode::kInvalidInput, where, message);
  }

  void checkAscending(const std::vector<std::string>& names, const char* field) {
    require(!names.empty(), field, "is empty, expected at least one name");
    if (!result_) return;
    require(!names.front().empty(), fmt::format("{}[0]", field), "is empty, expected a name");
    for (std::size_t n = 1; n < names.size(); ++n) {
      require(names[n - 1] < names[n], fmt::format("{}[{}]", field, n),
              "does not come after its predecessor, expected ascending names");
    }
  }

  void checkJoints() {
    std::set<std::string_view> seen;
    for (const std::string& joint : source_.start_joints) {
      require(!joint.empty() && seen.insert(joint).second, "start_joints",
              fmt::format("has '{}', expected each joint's name once", joint));
    }
    const std::size_t wanted = source_.episodes.size() * source_.start_joints.size();
    require(source_.start_positions.size() == wanted, "start_positions",
            fmt::format("has {} elements, expected {}, one for each episode and joint",
                        source_.start_positions.size(), wanted));
    const bool finite =
        std::all_of(source_.start_positions.begin(), source_.start_positions.end(), isAngle);
    require(finite, "start_positions",
            fmt::format("has an element that is not finite or over {}", kMostAngle));
  }

  void checkPlacement(std::size_t n) {
    const Placement& placement = source_.placements[n];
    if (placement.object < source_.objects.size() && isRigid(placement.pose)) return;
    require(false, fmt::format("placements[{}]", n),
            "expected one of the objects within 800 m with a rotation of length 1");
  }

  void checkEpisode(std::size_t n, std::size_t next) {
    const Episode& episode = source_.episodes[n];
    const std::string where = fmt::format("episodes[{}]", n);
    require(episode.scene < source_.scenes.size(), where + ".scene",
            fmt::format("is {}, expected one of {} scenes", episode.scene, source_.scenes.size()));
    require(episode.first_placement == next && episode.placement_count >= 1 &&
                episode.placement_count <= source_.placements.size() - next,
            where + ".first_placement",
            fmt::format("and count are {} and {}, expected {} and 1 to {}", episode.first_placement,
                        episode.placement_count, next, source_.placements.size() - next));
    require(episode.target < episode.placement_count, where + ".target",
            fmt::format("is {}, expected one of {} placements", episode.target,
                        episode.placement_count));
    require(isPlace(episode.base_position) && isAngle(episode.base_yaw), where + ".base_position",
            fmt::format("is not within {} m, or the yaw not within {} rad", kMaxCoordinate,
                        kMostAngle));
    require(isRigid(episode.goal), where + ".goal",
            "expected a place within 800 m and a rotation of length 1");
  }

  const SourceEpisodes& source_;
  Result<void> result_;
};

/// Exports rotate to the frames of mesh files and imports rotate back, both in double precision,
/// which restores each component to about 4e-16. So that this gives the same float, components are
/// multiples of 2^-48 (4e-15), as all floats from 2^-25 on are.
Quat rounded(const Quat& rotation) {
  constexpr double kSteps = 0x1p48;
  // Adding 0 turns -0 into 0.
  const auto round = [](float part) {
    return static_cast<float>(std::nearbyint(static_cast<double>(part) * kSteps) / kSteps + 0.0);
  };
  return {round(rotation.x), round(rotation.y), round(rotation.z), round(rotation.w)};
}

std::vector<Placement> rounded(std::vector<Placement> placements) {
  for (Placement& placement : placements) {
    placement.pose.rotation = rounded(placement.pose.rotation);
  }
  return placements;
}

std::vector<Episode> rounded(std::vector<Episode> episodes) {
  for (Episode& episode : episodes) episode.goal.rotation = rounded(episode.goal.rotation);
  return episodes;
}

std::uint64_t storedBytes(const SourceEpisodes& source) {
  return source.placements.size() * sizeof(Placement) + source.episodes.size() * sizeof(Episode) +
         source.start_positions.size() * sizeof(float);
}

}  // namespace

Result<std::vector<std::byte>> encodeEpisodePack(const SourceEpisodes& source,
                                                 const Provenance& provenance) {
  const std::uint64_t bytes = storedBytes(source);
  if (bytes > kMaxSurfaceBytes) {
    return fail(ErrorCode::kUnsupported, "",
                fmt::format("the episodes need {} MB, one pack holds less than 2048 MB; bake them "
                            "into several packs",
                            bytes >> 20U));
  }
  RETURN_IF_ERROR(EpisodeCheck(source).run());
  FlatBufferBuilder builder(static_cast<std::size_t>(bytes) + 65536);
  const auto provenance_table = provenanceTable(builder, provenance);
  const auto name = builder.CreateString(source.name);
  const auto scenes = builder.CreateVectorOfStrings(source.scenes);
  const auto objects = builder.CreateVectorOfStrings(source.objects);
  const auto robot = builder.CreateString(source.robot);
  const auto start_joints = builder.CreateVectorOfStrings(source.start_joints);
  const auto start_positions = alignedVector<float>(builder, source.start_positions);
  const auto placements = alignedStructs<schema::Placement>(builder, rounded(source.placements));
  const auto episodes = alignedStructs<schema::Episode>(builder, rounded(source.episodes));
  const auto root = schema::CreateEpisodeSet(builder, name, scenes, objects, robot, start_joints,
                                             start_positions, placements, episodes);
  return finishPack(builder, provenance_table, schema::Asset::EpisodeSet, root.Union());
}

Result<std::uint64_t> writeEpisodePack(const std::filesystem::path& path,
                                       const SourceEpisodes& source, const Provenance& provenance) {
  ASSIGN_OR_RETURN(const auto payload, encodeEpisodePack(source, provenance));
  return writePackFile(path, PackKind::kEpisodes, payload);
}

}  // namespace galactic::bake
