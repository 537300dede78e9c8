#pragma once
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

namespace galactic {

// Files that grow under another name beside their target, "TARGET.part-MACHINE-THREAD-NUMBER", and
// are renamed onto it when they are whole. A program that is killed leaves them behind; they are
// found by their names, and told from those that somebody still writes by a lock (flock) that goes
// with its holder. Some file systems keep the locks of each machine apart, or have none: MACHINE
// says where a file was begun, and others leave it alone until it is old. Where a name of the
// target's length leaves no room for the rest, TARGET is its beginning, a hash of it and its
// ending.

/// After this time nobody goes on writing a file that does not change.
inline constexpr std::chrono::seconds kPartAge = std::chrono::hours(24);

/// How the name of a part ends.
enum class PartEnding {
  kNumber,
  /// And then as its target, for programs that choose the format by it.
  kOfTarget,
};

/// The name for what this thread writes to `target`. Threads of all machines have names of their
/// own, but those of another container on this one; `number` is for trying again.
[[nodiscard]] std::filesystem::path partPathOf(const std::filesystem::path& target, unsigned number,
                                               PartEnding ending = PartEnding::kNumber);

/// Keeps the file that `descriptor`, open for reading, has open as `part` from being removed as
/// stale until the descriptor is closed. Answers whether it is there: it may have been removed
/// since it was made, and has then to be made again.
[[nodiscard]] bool holdPart(int descriptor, const std::filesystem::path& part);

/// A part under a name that no other file had, held while this lives.
class PartFile {
 public:
  /// An empty one, open for reading and writing. `error()` says why there is none.
  explicit PartFile(const std::filesystem::path& target, PartEnding ending = PartEnding::kNumber);
  /// A second name (hard link) of `source`, open for reading. `error()` says why there is none.
  [[nodiscard]] static PartFile linkedTo(const std::filesystem::path& source,
                                         const std::filesystem::path& target);
  /// Removes it, unless it was renamed.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  PartFile(PartFile&&) = delete;
  PartFile& operator=(PartFile&&) = delete;

  /// An error number; 0 where the part is there.
  [[nodiscard]] int error() const { return error_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Closed by the destructor; -1 where there is no part.
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  /// Makes the file of a name and opens it: a descriptor, or -1 and `errno`.
  using Make = std::function<int(const std::filesystem::path& part)>;
  PartFile(const std::filesystem::path& target, PartEnding ending, const Make& make);

  std::filesystem::path path_;
  int descriptor_ = -1;
  int error_ = 0;
};

/// Removes `part` if nobody holds it, and it was begun on this machine since that started, or has
/// not changed for `age`. Answers whether it has.
bool removeStalePart(const std::filesystem::path& part, std::chrono::seconds age = kPartAge);

/// Where parts are looked for.
struct PartSearch {
  /// Whether in the folders below, too; links are not followed.
  bool is_recursive = false;
  /// Only parts of a target of this name; empty: of any.
  std::string target{};
  /// Only parts of targets whose names it answers yes to, shortened where they are long; empty: of
  /// any.
  std::function<bool(std::string_view target)> accepts{};
  /// How many names are looked at, in the order of the file system.
  std::size_t most_names = std::numeric_limits<std::size_t>::max();
  std::chrono::seconds age = kPartAge;
};

/// Removes the stale parts in `folder`; how many they were. What cannot be looked at or removed
/// stays. Safe while other processes write there.
std::size_t removeStaleParts(const std::filesystem::path& folder, const PartSearch& search);

}  // namespace galactic
