#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace galactic::bake {

/// Why something that was drawn for an episode was not taken. In the order of the tests.
enum class EpisodeRejection : std::uint8_t {
  kDistance,           ///< The goal is nearer to the target or farther from it than asked.
  kSameSupport,        ///< The goal is on the target's surface, another was asked for.
  kNoRoom,             ///< The columns are not flat and free under and over the object.
  kUneven,             ///< Rays at the triangles found a gap, a slope or an edge under the object.
  kOutsideReceptacle,  ///< The object's middle is in no receptacle.
  kOverlap,            ///< Too near to another object or in the way of the robot's reach.
  kMoved,              ///< Settling moved the object, or it did not come to rest.
  kTipped,             ///< Settling tipped the object.
  kPlacement,          ///< A run would find no place for the object there if it were released.
  kNotReached,         ///< No position of base and arm reaches the object.
  kStartDistance,      ///< The start is nearer to the target or farther from it than asked.
  kStartBlocked,       ///< The robot would touch something at the start.
  kReplayBlocked,      ///< The runtime does not start the episode: the robot penetrates something.
  kReplayMoved,        ///< In the first step of a run something moved that should not.
};
inline constexpr std::size_t kRejectionCount = 14;

/// A short name, as in reports: "no_room".
[[nodiscard]] std::string_view rejectionName(EpisodeRejection reason);

/// How often each reason was met.
class RejectionCounts {
 public:
  void add(EpisodeRejection reason) { ++counts_[static_cast<std::size_t>(reason)]; }
  void add(const RejectionCounts& other) {
    for (std::size_t n = 0; n < kRejectionCount; ++n) counts_[n] += other.counts_[n];
  }
  [[nodiscard]] std::uint64_t operator[](EpisodeRejection reason) const {
    return counts_[static_cast<std::size_t>(reason)];
  }

 private:
  std::array<std::uint64_t, kRejectionCount> counts_{};
};

/// For people: "no_room 812, not_reached 14"; "nothing" where all are 0.
[[nodiscard]] std::string textOf(const RejectionCounts& counts);

}  // namespace galactic::bake
