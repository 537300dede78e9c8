#include "support/files/part_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <climits>
#include <fstream>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "support/content_hash.h"

namespace galactic {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = ".part-";
constexpr std::size_t kMachineDigits = 16;
constexpr std::string_view kHexDigits = "0123456789abcdef";
constexpr std::string_view kDigits = "0123456789";

/// Identifies this machine and its current boot; zeros if the system does not say.
std::string machineName() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string name;
  file >> name;
  std::erase(name, '-');
  const bool is_name =
      name.size() >= kMachineDigits && name.find_first_not_of(kHexDigits) == std::string::npos;
  return is_name ? name.substr(0, kMachineDigits) : std::string(kMachineDigits, '0');
}

/// The extension of a file's name, with its dot; empty if it is too long for an extension.
std::string endingOf(std::string_view file) {
  constexpr std::size_t kLongest = 16;
  std::string ending = fs::path(file).extension().string();
  return ending.size() <= kLongest ? ending : std::string();
}

/// Stands for a target in the names of its parts.
std::string standIn(const std::string& target) {
  // "-THREAD-NUMBER", of 32 bits each.
  constexpr std::size_t kNumbers = 22;
  constexpr std::size_t kHash = 1 + 16;
  const std::string ending = endingOf(target);
  const std::size_t most = NAME_MAX - kMark.size() - kMachineDigits - kNumbers - ending.size();
  // No file has a longer name; trying to create one fails with a proper error.
  if (target.size() <= most || target.size() > NAME_MAX) return target;
  std::size_t cut = most - kHash - ending.size();
  // Do not cut within a character: some file systems refuse invalid UTF-8.
  while (cut > 0 && (static_cast<unsigned char>(target[cut]) & 0xC0U) == 0x80U) --cut;
  const std::uint64_t hash = detail::contentHash(std::as_bytes(std::span(target))).low;
  return fmt::format("{}-{:016x}{}", target.substr(0, cut), hash, ending);
}

/// The parts of a part's name.
struct PartName {
  std::string_view target;
  std::string_view machine;
};

/// Whether `file` is the name of a part; must not take any other name for one.
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
  return rest.empty() || rest == endingOf(name.target);
}

bool isLocked(int descriptor, int operation) {
  int result = -1;
  do {
    result = ::flock(descriptor, operation);
  } while (result != 0 && errno == EINTR);
  return result == 0;
}

/// Whether `path` is the file that is open, and not another one or none.
bool isAt(const fs::path& path, const struct stat& open) {
  struct stat there {};
  return ::lstat(path.c_str(), &there) == 0 && there.st_dev == open.st_dev &&
         there.st_ino == open.st_ino;
}

/// By the time of its last status change, which links and renames update.
bool isOlder(const struct stat& file, std::chrono::seconds age) {
  // Not std::time(), which may lag some milliseconds behind the clock of the files.
  using Clock = std::chrono::system_clock;
  return Clock::to_time_t(Clock::now()) - file.st_ctim.tv_sec >= age.count();
}

/// A descriptor that is closed at the end of its scope.
class OpenPart {
 public:
  explicit OpenPart(const fs::path& path)
      // Locks over a network need a file that is open for writing.
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
std::vector<fs::path> partsIn(const fs::path& folder, const PartSearch& search) {
  std::vector<fs::path> parts;
  const std::string wanted = standIn(search.target);
  std::size_t looked_at = 0;
  std::error_code problem;
  for (Iterator at(folder, fs::directory_options::skip_permission_denied, problem), end;
       !problem && at != end && looked_at < search.most_names; at.increment(problem)) {
    ++looked_at;
    const std::string file = at->path().filename().string();
    PartName name;
    if (!parsePartName(file, name)) continue;
    const bool is_wanted = (wanted.empty() || name.target == wanted) &&
                           (!search.accepts || search.accepts(name.target));
    if (is_wanted) parts.push_back(at->path());
  }
  return parts;
}

}  // namespace

fs::path partPathOf(const fs::path& target, unsigned number, PartEnding ending) {
  const std::string name = standIn(target.filename().string());
  return target.parent_path() / fmt::format("{}{}{}-{}-{}{}", name, kMark, machineName(),
                                            ::gettid(), number,
                                            ending == PartEnding::kOfTarget ? endingOf(name) : "");
}

bool holdPart(int descriptor, const fs::path& part) {
  // A process that is about to remove the part has the lock: wait, and look whether the part is
  // gone. Where there are no locks, nobody removes a part before it is old.
  (void)isLocked(descriptor, LOCK_SH);
  struct stat open {};
  return ::fstat(descriptor, &open) == 0 && isAt(part, open);
}

PartFile::PartFile(const fs::path& target, PartEnding ending)
    : PartFile(target, ending, [](const fs::path& part) {
        // Exclusive, so that it neither follows a link nor shares a file.
        constexpr int kFlags = O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
        return ::open(part.c_str(), kFlags, 0666);
      }) {}

PartFile PartFile::linkedTo(const fs::path& source, const fs::path& target) {
  return PartFile(target, PartEnding::kNumber, [&source](const fs::path& part) {
    if (::link(source.c_str(), part.c_str()) != 0) return -1;
    const int descriptor = ::open(part.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor >= 0) return descriptor;
    const int problem = errno;
    ::unlink(part.c_str());
    // Removed as stale meanwhile, so another name may work.
    errno = problem == ENOENT ? EEXIST : problem;
    return -1;
  });
}

PartFile::PartFile(const fs::path& target, PartEnding ending, const Make& make) {
  const auto try_to_make = [&] {
    descriptor_ = make(path_);
    error_ = descriptor_ < 0 ? errno : 0;
  };
  constexpr unsigned kNames = 16;
  for (unsigned n = 0; n < kNames && descriptor_ < 0; ++n) {
    path_ = partPathOf(target, n, ending);
    try_to_make();
    // Make way by removing what a killed thread with the same number left behind.
    if (error_ == EEXIST && removeStalePart(path_)) try_to_make();
    if (error_ != 0 && error_ != EEXIST) return;
    if (error_ == 0 && !holdPart(descriptor_, path_)) ::close(std::exchange(descriptor_, -1));
  }
  if (descriptor_ < 0) error_ = EEXIST;
}

PartFile::~PartFile() {
  if (descriptor_ < 0) return;
  struct stat open {};
  // Remove first, while the part is still held.
  if (::fstat(descriptor_, &open) == 0 && isAt(path_, open)) ::unlink(path_.c_str());
  ::close(descriptor_);
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
  // Its maker has released it, so that it cannot become another file from here on.
  return isAt(part, status) && ::unlink(part.c_str()) == 0;
}

std::size_t removeStaleParts(const fs::path& folder, const PartSearch& search) {
  const fs::path from = folder.empty() ? fs::path(".") : folder;
  const std::vector<fs::path> parts = search.is_recursive
                                          ? partsIn<fs::recursive_directory_iterator>(from, search)
                                          : partsIn<fs::directory_iterator>(from, search);
  return static_cast<std::size_t>(std::count_if(parts.begin(), parts.end(), [&](const auto& part) {
    return removeStalePart(part, search.age);
  }));
}

}  // namespace galactic
