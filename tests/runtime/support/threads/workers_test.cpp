// Threads that step together: to be run under ThreadSanitizer too.
#include "support/threads/workers.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "galactic/simulation_options.h"
#include "support/limited_memory.h"
#include "support/sanitized.h"

namespace galactic::test::workers_test {
namespace {

using detail::Workers;

constexpr std::array<std::size_t, 4> kThreadCounts{1, 2, 3, 7};

/// What one thread writes, a cache line of its own. Not atomic: the rounds have to order it.
struct alignas(64) Slot {
  std::uint64_t rounds = 0;
  std::uint64_t sum = 0;
};

TEST(Workers, RunEveryThreadOnceInEachOfManyRounds) {
  for (const std::size_t threads : kThreadCounts) {
    std::vector<Slot> slots(threads);
    std::uint64_t input = 0;
    Workers workers(threads, [&](std::size_t n) {
      ++slots[n].rounds;
      slots[n].sum += input * (n + 1);
    });
    std::uint64_t wanted = 0;
    const std::uint64_t rounds = 2000 / threads;
    for (std::uint64_t round = 1; round <= rounds; ++round) {
      input = round;
      wanted += round;
      workers.begin();
      workers.end();
      for (std::size_t n = 0; n < threads; ++n) {
        ASSERT_EQ(slots[n].rounds, round);
        ASSERT_EQ(slots[n].sum, wanted * (n + 1));
      }
    }
  }
}

TEST(Workers, AreNoMoreThanAnybodyMayAskFor) {
  EXPECT_GE(detail::threadCount(0), 1U);
  EXPECT_EQ(detail::threadCount(3), 3U);
  EXPECT_EQ(detail::threadCount(kMostThreads), kMostThreads);
  EXPECT_EQ(detail::threadCount(1U << 20U), kMostThreads);
}

TEST(Workers, DoManyMorePartsThanThreadsEachOnceAndNeverTwoOnOneDesk) {
  for (const std::size_t threads : kThreadCounts) {
    constexpr std::size_t kParts = 53;
    std::vector<Slot> parts(kParts);
    // Not atomic either: no two parts may be at work on one desk.
    std::vector<Slot> desks(Workers::countFor(threads));
    Workers workers(threads, kParts, [&](std::size_t thread, std::size_t part) {
      ++parts[part].rounds;
      ++desks[thread].rounds;
    });
    for (std::uint64_t round = 1; round <= 500; ++round) {
      workers.begin();
      workers.end();
      std::uint64_t done = 0;
      for (const Slot& desk : desks) done += desk.rounds;
      ASSERT_EQ(done, round * kParts);
      for (const Slot& part : parts) ASSERT_EQ(part.rounds, round);
    }
  }
}

TEST(Workers, GoOnWithTheThreadsThatTheSystemGives) {
  if (kIsSanitized) GTEST_SKIP() << "a sanitizer maps more than a limit could allow";
  constexpr std::size_t kThreads = 512;
  constexpr std::uint64_t kRoomForStacks = std::uint64_t{128} << 20U;
  std::vector<Slot> parts(kThreads);
  const LimitedMemory limit(kRoomForStacks);
  Workers workers(kThreads, kThreads, [&](std::size_t, std::size_t n) { ++parts[n].rounds; });
  EXPECT_LT(workers.count(), kThreads);
  for (std::uint64_t round = 1; round <= 10; ++round) {
    workers.begin();
    workers.end();
    for (const Slot& part : parts) ASSERT_EQ(part.rounds, round);
  }
}

TEST(Workers, DoEachPartOnceAloneAndTogether) {
  for (const std::size_t threads : kThreadCounts) {
    constexpr std::size_t kParts = 11;
    std::vector<Slot> parts(kParts);
    const auto caller = std::this_thread::get_id();
    Slot by_caller;
    Workers workers(threads, kParts, [&](std::size_t thread, std::size_t part) {
      ++parts[part].rounds;
      if (std::this_thread::get_id() == caller) {
        EXPECT_EQ(thread, 0U);
        ++by_caller.rounds;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
    // Sooner or later it tries what takes less time.
    std::uint64_t round = 0;
    for (std::uint64_t alone = 0; alone < 2;) {
      const std::uint64_t before = by_caller.rounds;
      workers.run();
      ++round;
      for (const Slot& part : parts) ASSERT_EQ(part.rounds, round);
      alone += by_caller.rounds - before == kParts ? 1 : 0;
      ASSERT_LT(round, 2000U);
    }
    workers.begin();
    workers.end();
    for (const Slot& part : parts) EXPECT_EQ(part.rounds, round + 1);
  }
}

TEST(Workers, LeaveTheCallerFreeBetweenBeginAndEnd) {
  for (const std::size_t threads : kThreadCounts) {
    std::atomic<bool> may_go{false};
    std::vector<Slot> slots(threads);
    Workers workers(threads, [&](std::size_t n) {
      while (!may_go.load()) std::this_thread::yield();
      ++slots[n].rounds;
    });
    // Could not come back if begin() waited for the work.
    workers.begin();
    may_go.store(true);
    workers.end();
    for (const Slot& slot : slots) EXPECT_EQ(slot.rounds, 1U);
  }
}

TEST(Workers, WakeUpAfterTheyFellAsleep) {
  for (const std::size_t threads : kThreadCounts) {
    std::vector<Slot> slots(threads);
    Workers workers(threads, [&](std::size_t n) { ++slots[n].rounds; });
    for (std::uint64_t round = 1; round <= 5; ++round) {
      // Much longer than the threads stay awake.
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      workers.begin();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      workers.end();
      for (const Slot& slot : slots) ASSERT_EQ(slot.rounds, round);
    }
  }
}

TEST(Workers, WaitForASlowThread) {
  std::vector<Slot> slots(7);
  Workers workers(slots.size(), [&](std::size_t n) {
    if (n == 3) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ++slots[n].rounds;
  });
  for (int round = 0; round < 3; ++round) {
    workers.begin();
    workers.end();
    EXPECT_EQ(slots[3].rounds, slots[0].rounds);
  }
}

TEST(Workers, CanBeDestroyedWhileTheyWait) {
  for (const std::size_t threads : kThreadCounts) {
    for (int n = 0; n < 50; ++n) {
      std::vector<Slot> slots(threads);
      auto workers = std::make_unique<Workers>(threads, [&](std::size_t t) { ++slots[t].rounds; });
      for (int round = 0; round < n % 3; ++round) {
        workers->begin();
        workers->end();
      }
      workers.reset();
      for (const Slot& slot : slots) ASSERT_EQ(slot.rounds, static_cast<std::uint64_t>(n % 3));
    }
  }
}

TEST(Workers, WorkAndEndInAForkedProcessWithoutItsThreads) {
  for (const std::size_t threads : kThreadCounts) {
    std::vector<Slot> slots(threads);
    auto workers = std::make_unique<Workers>(threads, [&](std::size_t t) { ++slots[t].rounds; });
    workers->begin();
    workers->end();
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      workers->begin();
      workers->end();
      workers.reset();
      const bool is_done = std::ranges::all_of(slots, [](const Slot& s) { return s.rounds == 2; });
      _exit(is_done ? 0 : 1);
    }
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status << ", " << threads;
    workers->begin();
    workers->end();
    for (const Slot& slot : slots) EXPECT_EQ(slot.rounds, 2U);
  }
}

TEST(ForEachPart, DoesEachPartOnceOnAnyNumberOfThreads) {
  for (const std::uint32_t threads : {0U, 1U, 2U, 7U}) {
    std::vector<std::atomic<int>> done(50);
    detail::forEachPart(threads, done.size(), [&](std::size_t n) { ++done[n]; });
    for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1) << threads;
  }
}

TEST(ForEachPart, GivesTheCallerAnExceptionOnceAllThreadsAreDone) {
  for (const std::uint32_t threads : {1U, 3U}) {
    std::atomic<int> at_work = 0;
    const auto work = [&](std::size_t n) {
      ++at_work;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      --at_work;
      if (n == 5) throw std::runtime_error("part 5");
    };
    std::string what;
    try {
      detail::forEachPart(threads, 100'000, work);
    } catch (const std::runtime_error& error) {
      what = error.what();
    }
    EXPECT_EQ(what, "part 5");
    EXPECT_EQ(at_work, 0);
  }
}

}  // namespace
}  // namespace galactic::test::workers_test
