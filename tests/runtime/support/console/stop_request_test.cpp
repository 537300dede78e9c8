// What asks a program to end, and how it does.
#include "support/console/stop_request.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <functional>
#include <string>
#include <thread>

#include "galactic/error.h"
#include "support/child_process.h"
#include "support/console/standard_streams.h"

namespace galactic::test::stop_request_test {
namespace {

/// Looks again and again, for half a minute at most.
bool comesTrue(const std::function<bool()>& condition) {
  for (int n = 0; n < 6000 && !condition(); ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return condition();
}

/// Also where the tests were started with nohup.
void hearHangups() { std::signal(SIGHUP, SIG_DFL); }

constexpr std::array kRequests{SIGINT, SIGTERM, SIGHUP};
constexpr const char* kHeard = "\nbake: finishing what has begun; once more to stop at once\n";

TEST(StopRequest, IsWhatACtrlCASchedulerOrATerminalThatClosesSends) {
  for (const int signal : kRequests) {
    const ChildEnd end = inChild([signal] {
      hearHangups();
      const StopRequest stop("bake");
      if (stop.came()) return 1;
      ::kill(::getpid(), signal);
      return comesTrue([&] { return stop.came(); }) ? 0 : 2;
    });
    EXPECT_EQ(end.exit_code, 0) << signal;
    EXPECT_EQ(end.err, kHeard) << signal;
  }
}

TEST(StopRequest, IsNoHangupThatIsIgnored) {
  const ChildEnd end = inChild([] {
    std::signal(SIGHUP, SIG_IGN);
    const StopRequest stop("bake");
    ::kill(::getpid(), SIGHUP);
    // It would come first.
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (stop.came()) return 1;
    ::kill(::getpid(), SIGTERM);
    return comesTrue([&] { return stop.came(); }) ? 0 : 2;
  });
  EXPECT_EQ(end.exit_code, 0);
  EXPECT_EQ(end.err, kHeard);
}

TEST(StopRequest, EndsTheProgramTheSecondTimeUnlessItsTerminalClosesAgain) {
  const ChildEnd end = inChild([] {
    hearHangups();
    const StopRequest stop("bake");
    for (const int signal : {SIGHUP, SIGHUP, SIGTERM}) {
      ::kill(::getpid(), signal);
      std::this_thread::sleep_for(std::chrono::milliseconds(700));
      if (signal == SIGHUP) printToStderr(".");
    }
    return comesTrue([] { return false; }) ? 0 : 2;
  });
  EXPECT_EQ(end.exit_code, kExitInterrupted);
  EXPECT_EQ(end.err, kHeard + std::string(".."));
}

TEST(StopRequest, EndsWorkAtOnceThatIsNotWorthFinishing) {
  for (const int signal : kRequests) {
    const ChildEnd end = inChild([signal] {
      hearHangups();
      const StopRequest stop("bake", [] { return "go on later"; });
      ::kill(::getpid(), signal);
      return comesTrue([&] { return stop.came(); }) ? 0 : 2;
    });
    EXPECT_EQ(end.exit_code, kExitInterrupted) << signal;
    EXPECT_EQ(end.err, "\nbake: go on later\n") << signal;
  }
}

}  // namespace
}  // namespace galactic::test::stop_request_test
