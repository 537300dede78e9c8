#include "import/isolated_process.h"

#include <gmock/gmock.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <future>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "galactic/error.h"

namespace galactic::test::isolated_process_test {
namespace {

using bake::IsolatedWork;
using bake::ProcessChannel;
using bake::ProcessEnd;
using bake::ProcessFailure;
using bake::ProcessLimits;
using bake::runIsolated;

ProcessFailure failureOf(const IsolatedWork& work, const ProcessLimits& limits = {}) {
  const auto output = runIsolated(work, limits);
  EXPECT_FALSE(output.has_value()) << "the child was expected to fail";
  return output ? ProcessFailure{} : output.error();
}

std::vector<std::byte> pattern(std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(i * 31 % 251);
  return bytes;
}

TEST(IsolatedProcess, DeliversEverythingTheChildWrote) {
  for (const std::size_t size : {0UL, 1UL, 70'000UL, 5'000'000UL}) {
    const auto bytes = pattern(size);
    const auto output = runIsolated(
        [&](ProcessChannel& channel) {
          channel.write(std::span(bytes).first(size / 3));
          channel.write(std::span(bytes).subspan(size / 3));
        },
        {});
    ASSERT_TRUE(output.has_value());
    EXPECT_TRUE(
        std::equal(bytes.begin(), bytes.end(), output->bytes().begin(), output->bytes().end()));
  }
}

TEST(IsolatedProcess, ReportsTheSignalAndTheStageOfACrash) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE}) {
    const ProcessFailure failure = failureOf([&](ProcessChannel& channel) {
      channel.enterStage(7);
      ::raise(signal);
    });
    EXPECT_EQ(failure.end, ProcessEnd::kCrashed);
    EXPECT_EQ(failure.number, signal);
    EXPECT_EQ(failure.stage, 7U);
  }
}

TEST(IsolatedProcess, BlamesNoFileForWhatKilledTheChild) {
  const auto killed = [] { (void)failureOf([](ProcessChannel&) { ::raise(SIGKILL); }); };
  EXPECT_THROW(killed(), ErrorException);
}

TEST(IsolatedProcess, FinishesWhenItsGroupIsToldToEnd) {
  const auto output = runIsolated(
      [](ProcessChannel& channel) {
        for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) ::raise(signal);
        channel.write(std::as_bytes(std::span("whole", 5)));
      },
      {});
  ASSERT_TRUE(output.has_value());
  EXPECT_EQ(output->bytes().size(), 5U);
}

TEST(IsolatedProcess, ReportsExceptionsExitsAndLackOfMemoryApart) {
  EXPECT_EQ(failureOf([](ProcessChannel&) { throw std::runtime_error("broken"); }).end,
            ProcessEnd::kFailed);
  const ProcessFailure exit = failureOf([](ProcessChannel&) { ::_exit(3); });
  EXPECT_EQ(exit.end, ProcessEnd::kFailed);
  EXPECT_EQ(exit.number, 3);
  EXPECT_EQ(failureOf([](ProcessChannel&) { throw std::bad_alloc(); }).end,
            ProcessEnd::kMemoryLimit);
}

TEST(IsolatedProcess, EndsAChildThatRunsTooLong) {
  const ProcessFailure busy = failureOf(
      [](ProcessChannel&) {
        for (volatile int i = 0; true;) i = i + 1;
      },
      {.wall_clock = std::chrono::milliseconds(200)});
  EXPECT_EQ(busy.end, ProcessEnd::kTimeLimit);
  const ProcessFailure idle =
      failureOf([](ProcessChannel&) { ::pause(); }, {.wall_clock = std::chrono::milliseconds(200)});
  EXPECT_EQ(idle.end, ProcessEnd::kTimeLimit);
}

TEST(IsolatedProcess, EndsAChildThatUsesTooMuchMemory) {
  constexpr std::uint64_t kLimit = std::uint64_t{64} << 20U;
  const ProcessFailure failure = failureOf(
      [](ProcessChannel&) {
        std::vector<std::vector<char>> hoard;
        while (true) hoard.emplace_back(std::size_t{1} << 20U, '\1');
      },
      {.wall_clock = std::chrono::seconds(60), .memory = kLimit});
  EXPECT_EQ(failure.end, ProcessEnd::kMemoryLimit);
}

TEST(IsolatedProcess, EndsAChildThatWritesTooMuch) {
  const ProcessFailure failure = failureOf(
      [](ProcessChannel& channel) {
        const auto block = pattern(std::size_t{1} << 16U);
        while (true) channel.write(block);
      },
      {.wall_clock = std::chrono::seconds(60), .memory = std::uint64_t{8} << 20U});
  EXPECT_EQ(failure.end, ProcessEnd::kMemoryLimit);
}

TEST(IsolatedProcess, KeepsWhatTheChildPrintsFromTheUser) {
  testing::internal::CaptureStderr();
  const auto output = runIsolated(
      [](ProcessChannel&) {
        static_cast<void>(!::write(STDERR_FILENO, "noise", 5));
        static_cast<void>(!::write(STDOUT_FILENO, "noise", 5));
      },
      {});
  EXPECT_TRUE(output.has_value());
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(IsolatedProcess, WorksFromSeveralThreadsAtOnce) {
  const auto task = [](int number) {
    const auto output = runIsolated(
        [&](ProcessChannel& channel) {
          const std::vector<int> numbers(1000, number);
          channel.write(std::as_bytes(std::span(numbers)));
        },
        {});
    return output && output->bytes().size() == 1000 * sizeof(int) &&
           output->bytes().front() == static_cast<std::byte>(number);
  };
  std::vector<std::future<bool>> results;
  results.reserve(16);
  for (int i = 0; i < 16; ++i) results.push_back(std::async(std::launch::async, task, i));
  for (auto& result : results) EXPECT_TRUE(result.get());
}

TEST(IsolatedProcess, DoesNotWaitForTheChildrenOfOtherThreads) {
  // A slow child forked in between must not hold the quick one's pipe open: if it did, the quick
  // call would run into its limit.
  auto slow = std::async(std::launch::async, [] {
    return runIsolated([](ProcessChannel&) { ::pause(); },
                       {.wall_clock = std::chrono::milliseconds(1500)})
        .has_value();
  });
  for (int i = 0; i < 50; ++i) {
    EXPECT_TRUE(runIsolated([](ProcessChannel&) {}, {.wall_clock = std::chrono::seconds(60)}));
  }
  EXPECT_FALSE(slow.get());
}

}  // namespace
}  // namespace galactic::test::isolated_process_test
