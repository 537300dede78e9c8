// Rounds alone or together, with clocks that the tests make up.
#include "support/threads/alone_or_together.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>

#include "support/oracles/resting_oracle.h"

namespace galactic::test::alone_or_together_test {
namespace {

using detail::AloneOrTogether;
using detail::RoundWay;
using std::chrono::duration_cast;
using Seconds = std::chrono::duration<double>;

/// What many rounds took.
struct Played {
  double seconds = 0;
  double seconds_alone = 0;
  int rounds = 0;
  int rounds_alone = 0;
  int changes = 0;
};

/// Plays `seconds` of rounds. `round`: what the next one takes, seconds, done a way.
template <class Round>
Played play(AloneOrTogether& choice, double seconds, const Round& round) {
  Played played;
  RoundWay before = choice.next();
  while (played.seconds < seconds) {
    const RoundWay way = choice.next();
    const double took = round(way);
    choice.add(duration_cast<AloneOrTogether::Duration>(Seconds(took)));
    played.seconds += took;
    ++played.rounds;
    played.changes += way != before ? 1 : 0;
    before = way;
    if (way != RoundWay::kAlone) continue;
    played.seconds_alone += took;
    ++played.rounds_alone;
  }
  return played;
}

constexpr double kAlone = 100e-6;

TEST(AloneOrTogether, StaysTogetherWhereThatTakesLessTime) {
  AloneOrTogether choice;
  const auto round = [](RoundWay way) { return way == RoundWay::kAlone ? kAlone : 0.53 * kAlone; };
  EXPECT_EQ(choice.next(), RoundWay::kTogether);
  // It has to try what it knows nothing of.
  EXPECT_GT(play(choice, 2, round).rounds_alone, 0);
  const Played later = play(choice, 60, round);
  EXPECT_LT(later.seconds_alone, 0.02 * later.seconds);
}

TEST(AloneOrTogether, GoesOnAloneWhereTheOthersAreInTheWay) {
  AloneOrTogether choice;
  const auto round = [](RoundWay way) { return way == RoundWay::kAlone ? kAlone : 1.12 * kAlone; };
  play(choice, 2, round);
  EXPECT_EQ(choice.next(), RoundWay::kAlone);
  const Played later = play(choice, 60, round);
  EXPECT_GT(later.seconds_alone, 0.98 * later.seconds);
}

TEST(AloneOrTogether, TakesBackAChoiceWhenTimesChange) {
  AloneOrTogether choice;
  const auto quiet = [](RoundWay way) { return way == RoundWay::kAlone ? kAlone : 0.53 * kAlone; };
  const auto busy = [](RoundWay way) { return way == RoundWay::kAlone ? kAlone : 1.12 * kAlone; };
  for (int n = 0; n < 3; ++n) {
    play(choice, 30, quiet);
    // What is slower than usual is doubted at once.
    const Played first = play(choice, 1, busy);
    EXPECT_GT(first.seconds_alone, 0.4);
    play(choice, 30, busy);
    EXPECT_EQ(choice.next(), RoundWay::kAlone);
    // Nothing but a trial says that there is room again.
    play(choice, 5, quiet);
    const Played later = play(choice, 10, quiet);
    EXPECT_LT(later.seconds_alone, 0.5);
  }
}

TEST(AloneOrTogether, DoubtsNothingWhileItIsAlone) {
  const auto share_together = [](double worse) {
    AloneOrTogether choice;
    double slower = 1;
    const auto round = [&](RoundWay way) {
      return slower * (way == RoundWay::kAlone ? kAlone : 1.5 * kAlone);
    };
    play(choice, 20, round);
    EXPECT_EQ(choice.next(), RoundWay::kAlone);
    // Neighbors come and go, and take as much of the processor from all.
    Played all;
    for (int n = 0; n < 60; ++n) {
      slower = n % 3 == 0 ? worse : 1;
      const Played played = play(choice, 1, round);
      all.seconds += played.seconds;
      all.seconds_alone += played.seconds_alone;
    }
    return 1 - all.seconds_alone / all.seconds;
  };
  const double steady = share_together(1);
  const double changing = share_together(2);
  std::printf("together: %.4f of the time, %.4f where neighbors come and go\n", steady, changing);
  EXPECT_LT(changing, 1.25 * steady);
}

TEST(AloneOrTogether, IsHardlySlowerThanTheBetterWayWhereTimesVary) {
  constexpr std::uint32_t kSeed = 1701;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  for (const double wait : {1.5e-3, 3e-3, 6e-3}) {
    for (const double mean : {0.6, 0.8, 0.95, 1.05, 1.2, 1.5}) {
      // Together, most rounds take half of the time, and a few wait for a thread that was stopped.
      const double chance = (mean - 0.53) * kAlone / wait;
      AloneOrTogether choice;
      const auto round = [&](RoundWay way) {
        if (way == RoundWay::kAlone)
          return kAlone * static_cast<double>(uniformIn(random, 0.9F, 1.1F));
        const bool waits = static_cast<double>(uniformIn(random, 0, 1)) < chance;
        return 0.53 * kAlone + (waits ? wait : 0);
      };
      play(choice, 5, round);
      const Played played = play(choice, 40, round);
      const double best = std::min(mean, 1.0) * kAlone;
      std::printf("mean %.2f, waits %.1f ms: %.3f of the better way, %d changes\n", mean,
                  1e3 * wait, played.seconds / played.rounds / best, played.changes);
      EXPECT_LT(played.seconds / played.rounds, 1.06 * best)
          << "mean " << mean << ", waits " << wait;
      EXPECT_LT(played.changes, 400) << "mean " << mean << ", waits " << wait;
    }
  }
}

}  // namespace
}  // namespace galactic::test::alone_or_together_test
