// What programs print is lost when it cannot be written, and nothing else is.
#include "support/console/standard_streams.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <functional>
#include <initializer_list>

namespace galactic::test::standard_streams_test {
namespace {

constexpr std::array kStreams{STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO};

/// Whether `holds` is true in a process whose `closed` streams are closed.
bool holdsWithout(std::initializer_list<int> closed, const std::function<bool()>& holds) {
  const pid_t child = ::fork();
  if (child == 0) {
    for (const int stream : closed) ::close(stream);
    ::_exit(holds() ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(StandardStreams, ThatAreClosedAreNotTheFileThatIsOpenedNext) {
  for (const int stream : kStreams) {
    const auto next = [] { return ::open("/dev/null", O_RDWR | O_CLOEXEC); };
    EXPECT_TRUE(holdsWithout({stream}, [&] { return next() == stream; })) << "the danger";
    EXPECT_TRUE(holdsWithout({stream}, [&] {
      prepareStandardStreams();
      return next() > STDERR_FILENO;
    })) << stream;
  }
  EXPECT_TRUE(holdsWithout({STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}, [] {
    prepareStandardStreams();
    char byte = 0;
    return ::read(STDIN_FILENO, &byte, 1) == -1 && ::write(STDOUT_FILENO, "x", 1) == -1 &&
           ::write(STDERR_FILENO, "x", 1) == -1;
  })) << "using them fails as before";
}

TEST(StandardStreams, ThatAreOpenStayAsTheyAre) {
  EXPECT_TRUE(holdsWithout({}, [] {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0 || ::dup2(pipe[1], STDERR_FILENO) < 0) return false;
    prepareStandardStreams();
    printToStderr("said");
    std::array<char, 8> text{};
    return ::read(pipe[0], text.data(), text.size()) == 4;
  }));
}

TEST(StandardStreams, LoseWhatAFullDiskDoesNotTake) {
  EXPECT_TRUE(holdsWithout({}, [] {
    const int full = ::open("/dev/full", O_WRONLY);
    if (full < 0 || ::dup2(full, STDERR_FILENO) < 0) return false;
    printToStderr("lost\n");
    return true;
  }));
}

}  // namespace
}  // namespace galactic::test::standard_streams_test
