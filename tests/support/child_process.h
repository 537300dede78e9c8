#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <functional>
#include <string>

namespace galactic::test {

/// How a process ended.
struct ChildEnd {
  /// -1 when it was killed by a signal.
  int exit_code = -1;
  /// The signal; 0 for none.
  int signal = 0;
  std::string err;
};

/// Does `work` in a process of its own, which ends with what it returns.
[[nodiscard]] inline ChildEnd inChild(const std::function<int()>& work) {
  ChildEnd end;
  std::array<int, 2> pipe{};
  if (::pipe(pipe.data()) != 0) return end;
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(pipe[1], STDERR_FILENO);
    ::close(pipe[0]);
    ::close(pipe[1]);
    ::_exit(work());
  }
  ::close(pipe[1]);
  std::array<char, 256> text{};
  ssize_t length = 0;
  while ((length = ::read(pipe[0], text.data(), text.size())) > 0) {
    end.err.append(text.data(), static_cast<std::size_t>(length));
  }
  ::close(pipe[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  return end;
}

}  // namespace galactic::test
