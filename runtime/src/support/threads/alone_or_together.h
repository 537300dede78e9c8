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

/// Finds out whether rounds of the same work are faster together or alone. Where other programs
/// keep the processor busy, a thread that waits for its turn makes the other threads of its round
/// wait too, and may cost more than it contributes. Measured times decide: rounds come in
/// stretches, most of them done the better way; now and then a stretch is done the other way, and
/// more rarely the longer that way stays worse.
class AloneOrTogether {
 public:
  using Duration = std::chrono::steady_clock::duration;

  /// How to do the next round.
  [[nodiscard]] RoundWay next() const { return tries_other_ ? otherThan(better_) : better_; }

  /// Reports that the next round, done as next() says, took this long.
  void add(Duration took);

 private:
  static RoundWay otherThan(RoundWay way) {
    return way == RoundWay::kAlone ? RoundWay::kTogether : RoundWay::kAlone;
  }
  void endStretch();
  /// Whether rounds together have become so slow that alone may be better now.
  [[nodiscard]] bool isDoubtful() const;

  RoundWay better_ = RoundWay::kTogether;
  bool tries_other_ = false;
  /// Of the current stretch.
  Duration time_{0};
  std::uint32_t rounds_ = 0;
  /// Seconds per round done the better way, over the long run and recently; 0 if unknown.
  double usual_ = 0;
  double lately_ = 0;
  /// Stretches since the other way was last tried, and between two trials of it.
  std::uint32_t since_trial_ = 0;
  std::uint32_t wait_ = kFirstWait;

  static constexpr std::uint32_t kFirstWait = 8;
};

}  // namespace galactic::detail
