#include "support/part_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

namespace galactic {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = ".part-";
constexpr std::size_t kMachineDigits = 16;
constexpr std::string_view kHexDigits = "0123456789abcdef";
constexpr std::string_view kDigits = "0123456789";

/// What tells this machine, since it started, from all others; zeros where it does not say.
std::string machineName() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string name;
  file >> name;
  std::erase(name, '-');
  const bool is_name =
      name.size() >= kMachineDigits && name.find_first_not_of(kHexDigits) == std::string::npos;
  return is_name ? name.substr(0, kMachineDigits) : std::string(kMachineDigits, '0');
}

/// The parts of a part's name.
struct PartName {
  std::string_view target;
  std::string_view machine;
};

/// Whether `file` is such a name; nothing else may be taken for one.
bool parsePartName(std::string_view file, PartName& name) {
  const std::size_t mark = file.rfind(kMark);
  if (mark == std::string_view::npos || mark == 0) return false;
  std::string_view rest = file.substr(mark + kMark.size());
  if (rest.size() <= kMachineDigits) return false;
  name.target = file.substr(0, mark);
  name.machine = rest.substr(0, kMachineDigits);
  rest.remove_prefix(kMachineDigits);
  if (name.machine.find_first_not_of(kHexDigits) != std::string_view::npos) return false;
  // "-THREAD-NUMBER"
  for (int n = 0; n < 2; ++n) {
    if (rest.empty() || rest.front() != '-') return false;
    rest.remove_prefix(1);
    const std::size_t digits = std::min(rest.find_first_not_of(kDigits), rest.size());
    if (digits == 0) return false;
    rest.remove_prefix(digits);
  }
  return rest.empty();
}

bool isLocked(int descriptor, int operation) {
  int result = -1;
  do {
    result = ::flock(descriptor, operation);
  } while (result != 0 && errno == EINTR);
  return result == 0;
}

/// Whether `path` is the file that is open, not another or none.
bool isAt(const fs::path& path, const struct stat& open) {
  struct stat there {};
  return ::lstat(path.c_str(), &there) == 0 && there.st_dev == open.st_dev &&
         there.st_ino == open.st_ino;
}

/// By the time of its last change, which links and renames count as.
bool isOlder(const struct stat& file, std::chrono::seconds age) {
  // Not std::time(), which may be some milliseconds behind the clock of the files.
  using Clock = std::chrono::system_clock;
  return Clock::to_time_t(Clock::now()) - file.st_ctim.tv_sec >= age.count();
}

/// A descriptor that is closed at the end of its scope.
class OpenPart {
 public:
  explicit OpenPart(const fs::path& path)
      // Locks that go over a network want a file that is open for writing.
      : descriptor_(::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK)) {}
  ~OpenPart() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenPart(const OpenPart&) = delete;
  OpenPart& operator=(const OpenPart&) = delete;
  OpenPart(OpenPart&&) = delete;
  OpenPart& operator=(OpenPart&&) = delete;
  [[nodiscard]] int get() const { return descriptor_; }

 private:
  int descriptor_;
};

/// The parts that `Iterator` finds.
template <class Iterator>
std::vector<fs::path> partsIn(const fs::path& folder, std::string_view target) {
  std::vector<fs::path> parts;
  std::error_code problem;
  for (Iterator at(folder, fs::directory_options::skip_permission_denied, problem), end;
       !problem && at != end; at.increment(problem)) {
    const std::string file = at->path().filename().string();
    PartName name;
    if (!parsePartName(file, name)) continue;
    if (target.empty() || name.target == target) parts.push_back(at->path());
  }
  return parts;
}

}  // namespace

fs::path partPathOf(const fs::path& target, unsigned number) {
  return target.string() + fmt::format("{}{}-{}-{}", kMark, machineName(), ::gettid(), number);
}

bool holdPart(int descriptor, const fs::path& part) {
  // Who is about to remove it has the lock: wait, and look whether it is gone. Where there are no
  // locks, nobody removes it before it is old.
  (void)isLocked(descriptor, LOCK_SH);
  struct stat open {};
  return ::fstat(descriptor, &open) == 0 && isAt(part, open);
}

bool removeStalePart(const fs::path& part, std::chrono::seconds age) {
  const std::string file = part.filename().string();
  PartName name;
  if (!parsePartName(file, name)) return false;
  const OpenPart open(part);
  struct stat status {};
  if (open.get() < 0 || ::fstat(open.get(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  const bool is_locked = isLocked(open.get(), LOCK_EX | LOCK_NB);
  if (!is_locked && errno == EWOULDBLOCK) return false;
  const bool is_ours = is_locked && name.machine == machineName();
  if (!is_ours && !isOlder(status, age)) return false;
  // Whoever made it has let go of it, so that it cannot become another file from here on.
  return isAt(part, status) && ::unlink(part.c_str()) == 0;
}

std::size_t removeStaleParts(const fs::path& folder, const PartSearch& search) {
  const fs::path from = folder.empty() ? fs::path(".") : folder;
  const std::vector<fs::path> parts =
      search.is_recursive ? partsIn<fs::recursive_directory_iterator>(from, search.target)
                          : partsIn<fs::directory_iterator>(from, search.target);
  return static_cast<std::size_t>(std::count_if(parts.begin(), parts.end(), [&](const auto& part) {
    return removeStalePart(part, search.age);
  }));
}

}  // namespace galactic
