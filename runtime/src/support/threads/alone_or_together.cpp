#include "support/threads/alone_or_together.h"

#include <algorithm>

namespace galactic::detail {
namespace {

/// Much longer than a system lets a thread run before it is another's turn, which is a few
/// milliseconds.
constexpr std::chrono::milliseconds kStretch{20};
/// Stretches between trials at most: a trial of what takes twice the time costs less than 1 %.
constexpr std::uint32_t kLongestWait = 160;
/// What a way has to be better by, so that nothing changes from one to the other and back.
constexpr double kClearly = 0.97;
/// How much slower than usual rounds together have to be to be worth a doubt, and how much sooner
/// the other way is tried then.
constexpr double kSlower = 1.15;
constexpr std::uint32_t kSooner = 8;
/// What a stretch counts for.
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
  // Where rounds alone get slower, another program came, and there is less room for two than
  // before.
  return better_ == RoundWay::kTogether && lately_ > kSlower * usual_;
}

}  // namespace galactic::detail
