#include "support/console/prepare_program.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "galactic/error.h"
#include "support/console/standard_streams.h"

namespace galactic {
namespace {

// What follows runs in a signal handler: no memory, no locks, no streams.

/// Text of limited length; what does not fit is left out.
template <std::size_t kMost>
class FixedText {
 public:
  void append(std::string_view more) {
    const std::size_t length = std::min(more.size(), kMost - length_);
    std::copy_n(more.begin(), length, text_.begin() + static_cast<std::ptrdiff_t>(length_));
    length_ += length;
  }
  void clear() { length_ = 0; }
  [[nodiscard]] std::string_view view() const { return {text_.data(), length_}; }

 private:
  std::array<char, kMost> text_;
  std::size_t length_ = 0;
};

/// A line of /proc/self/maps: "BEGIN-END RIGHTS OFFSET DEVICE INODE    /PATH", in hexadecimal.
using MapsLine = FixedText<PATH_MAX + 128>;

/// Whether the address is in the range of a line.
bool holds(std::string_view line, std::uintptr_t address) {
  std::uintptr_t begin = 0;
  std::uintptr_t end = 0;
  const char* const last = line.data() + line.size();
  const auto first = std::from_chars(line.data(), last, begin, 16);
  if (first.ptr == last || *first.ptr != '-') return false;
  (void)std::from_chars(first.ptr + 1, last, end, 16);
  return begin <= address && address < end;
}

/// Leaves the line that contains the address in `line`; nothing if there is none.
void findMapping(std::uintptr_t address, MapsLine& line) {
  const int file = ::open("/proc/self/maps", O_RDONLY | O_CLOEXEC);
  std::array<char, 1024> bytes;
  ssize_t length = 0;
  while (file >= 0 && (length = ::read(file, bytes.data(), bytes.size())) > 0) {
    for (const char& byte : std::string_view(bytes.data(), static_cast<std::size_t>(length))) {
      if (byte != '\n') {
        line.append({&byte, 1});
        continue;
      }
      if (holds(line.view(), address)) return;
      line.clear();
    }
  }
  line.clear();
}

/// The handler of SIGBUS.
void endForLostFile(int signal, siginfo_t* info, void* /*context*/) {
  MapsLine line;
  if (info->si_code == BUS_ADRERR) {
    findMapping(reinterpret_cast<std::uintptr_t>(info->si_addr), line);
  }
  const std::size_t path = line.view().find('/');
  if (path == std::string_view::npos) {
    // Raised for another reason: behave as if there were no handler as soon as this returns.
    std::signal(signal, SIG_DFL);
    (void)::raise(signal);
    return;
  }
  // All threads that work on the file may get here at the same time.
  static std::atomic_flag is_told = ATOMIC_FLAG_INIT;
  while (is_told.test_and_set()) ::pause();
  FixedText<PATH_MAX + 512> text;
  text.append(program_invocation_short_name);
  text.append(": ");
  for (const char& byte : line.view().substr(path)) {
    const bool is_printable = static_cast<unsigned char>(byte) >= ' ' && byte != '\x7f';
    text.append(is_printable ? std::string_view(&byte, 1) : "?");
  }
  text.append(
      ": was cut short while it was in use, or its disk cannot read it any more; start again, and "
      "replace files that are in use by new ones, rather than write into them\n");
  (void)!::write(STDERR_FILENO, text.view().data(), text.view().size());
  ::_exit(static_cast<int>(ErrorCode::kIo));
}

}  // namespace

void prepareProgram() noexcept {
  prepareStandardStreams();
  struct sigaction action {};
  action.sa_sigaction = endForLostFile;
  action.sa_flags = SA_SIGINFO;
  ::sigaction(SIGBUS, &action, nullptr);
}

}  // namespace galactic
