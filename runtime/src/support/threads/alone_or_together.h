#pragma once
#include <chrono>
#include <cstdint>

namespace galactic::detail {

/// How a round of work is done.
enum class RoundWay : std::uint8_t {
  /// By all threads.
  kTogether,
  /// By the caller, while the others sleep.
  kAlone,
};

/// Finds out whether rounds of the same work take less time together or alone. Where other programs
/// keep the processor busy, a thread that waits for its turn has the others of its round wait too,
/// and may cost more than it brings. What rounds took tells best: stretches of rounds are done the
/// better way, and now and then one the other way, seldom while that is worse.
class AloneOrTogether {
 public:
  using Duration = std::chrono::steady_clock::duration;

  /// Of the next round.
  [[nodiscard]] RoundWay next() const { return tries_other_ ? otherThan(better_) : better_; }

  /// The next round, done that way, took so long.
  void add(Duration took);

 private:
  static RoundWay otherThan(RoundWay way) {
    return way == RoundWay::kAlone ? RoundWay::kTogether : RoundWay::kAlone;
  }
  void endStretch();
  /// Whether rounds together take so much longer than they did that alone may be better now.
  [[nodiscard]] bool isDoubtful() const;

  RoundWay better_ = RoundWay::kTogether;
  bool tries_other_ = false;
  /// Of the stretch that is in work.
  Duration time_{0};
  std::uint32_t rounds_ = 0;
  /// What a round takes the better way, seconds, for long and lately; 0 where that is not known.
  double usual_ = 0;
  double lately_ = 0;
  /// Stretches since the other way was tried, and until it is tried again.
  std::uint32_t since_trial_ = 0;
  std::uint32_t wait_ = kFirstWait;

  static constexpr std::uint32_t kFirstWait = 8;
};

}  // namespace galactic::detail
