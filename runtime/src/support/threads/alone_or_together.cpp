#include "support/threads/alone_or_together.h"

#include <algorithm>

namespace galactic::detail {
namespace {

/// Much longer than the few milliseconds that a system lets a thread run before another one's turn.
constexpr std::chrono::milliseconds kStretch{20};
/// At most this many stretches between trials: a trial that takes twice as long then costs less
/// than 1 %.
constexpr std::uint32_t kLongestWait = 160;
/// How much better the other way has to be, so that the choice does not flip back and forth.
constexpr double kClearly = 0.97;
/// How much slower than usual rounds together have to be to raise a doubt, and how much sooner the
/// other way is tried then.
constexpr double kSlower = 1.15;
constexpr std::uint32_t kSooner = 8;
/// The weight of a stretch in the averages.
constexpr double kForLong = 1.0 / 64;
constexpr double kForLately = 1.0 / 5;

}  // namespace

void AloneOrTogether::add(Duration took) {
  time_ += took;
  ++rounds_;
  if (time_ >= kStretch) endStretch();
}

void AloneOrTogether::endStretch() {
  const double round = std::chrono::duration<double>(time_).count() / rounds_;
  time_ = Duration{0};
  rounds_ = 0;
  if (tries_other_) {
    tries_other_ = false;
    since_trial_ = 0;
    const bool is_better = round < kClearly * lately_;
    wait_ = is_better ? kFirstWait : std::min(2 * wait_, kLongestWait);
    if (!is_better) return;
    better_ = otherThan(better_);
    usual_ = lately_ = round;
    return;
  }
  if (usual_ == 0) usual_ = lately_ = round;
  usual_ += kForLong * (round - usual_);
  lately_ += kForLately * (round - lately_);
  ++since_trial_;
  tries_other_ = since_trial_ >= (isDoubtful() ? wait_ / kSooner : wait_);
}

bool AloneOrTogether::isDoubtful() const {
  // When rounds alone get slower, another program has started, and there is even less room for two
  // threads than before: no reason to doubt.
  return better_ == RoundWay::kTogether && lately_ > kSlower * usual_;
}

}  // namespace galactic::detail
