#pragma once
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

namespace galactic {

// Parts: files that grow under another name beside their target,
// "TARGET.part-MACHINE-THREAD-NUMBER", and are renamed onto the target when they are whole. A
// program that is killed leaves its parts behind. They are found by their names; a lock (flock),
// which ends with the process that holds it, marks the parts that are still being written. Some
// file systems keep the locks of each machine apart, or have no locks: MACHINE is where a part was
// begun, and other machines leave the part alone until it is old. Where a long target name leaves
// no room for the rest, TARGET is the beginning of that name, a hash of it and its extension.

/// A part that has not changed for this long is considered abandoned.
inline constexpr std::chrono::seconds kPartAge = std::chrono::hours(24);

/// How the name of a part ends.
enum class PartEnding {
  kNumber,
  /// Followed by the target's extension, for programs that choose the format by it.
  kOfTarget,
};

/// The name of this thread's part for `target`. No two threads of any machines share a name, except
/// between containers on the same machine; `number` is for trying again.
[[nodiscard]] std::filesystem::path partPathOf(const std::filesystem::path& target, unsigned number,
                                               PartEnding ending = PartEnding::kNumber);

/// Keeps `part`, which `descriptor` has open for reading, from being removed as stale until the
/// descriptor is closed. Returns whether the part still exists: it may have been removed since it
/// was made, and must then be made again.
[[nodiscard]] bool holdPart(int descriptor, const std::filesystem::path& part);

/// A part under a name that no other file had, held as long as this object lives.
class PartFile {
 public:
  /// An empty part, open for reading and writing. If it cannot be made, `error()` is the reason.
  explicit PartFile(const std::filesystem::path& target, PartEnding ending = PartEnding::kNumber);
  /// A second name (hard link) of `source`, open for reading. If it cannot be made, `error()` is
  /// the reason.
  [[nodiscard]] static PartFile linkedTo(const std::filesystem::path& source,
                                         const std::filesystem::path& target);
  /// Removes the part, unless it was renamed.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  PartFile(PartFile&&) = delete;
  PartFile& operator=(PartFile&&) = delete;

  /// An error number; 0 if the part exists.
  [[nodiscard]] int error() const { return error_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Closed by the destructor; -1 if there is no part.
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  /// Makes a file of this name and opens it. Returns the descriptor, or -1 and sets `errno`.
  using Make = std::function<int(const std::filesystem::path& part)>;
  PartFile(const std::filesystem::path& target, PartEnding ending, const Make& make);

  std::filesystem::path path_;
  int descriptor_ = -1;
  int error_ = 0;
};

/// Removes `part` if nobody holds it, and it was either begun on this machine since its last boot
/// or has not changed for `age`. Returns whether it removed the part.
bool removeStalePart(const std::filesystem::path& part, std::chrono::seconds age = kPartAge);

/// Where to look for parts.
struct PartSearch {
  /// Also search the folders below; links are not followed.
  bool is_recursive = false;
  /// Only parts of a target with this name; empty: of any target.
  std::string target{};
  /// Only parts of targets whose names this function accepts (long names are shortened); empty: of
  /// any target.
  std::function<bool(std::string_view target)> accepts{};
  /// How many names to look at, in the order of the file system.
  std::size_t most_names = std::numeric_limits<std::size_t>::max();
  std::chrono::seconds age = kPartAge;
};

/// Removes the stale parts in `folder` and returns their number. Leaves what it cannot examine or
/// remove. Safe while other processes write there.
std::size_t removeStaleParts(const std::filesystem::path& folder, const PartSearch& search);

}  // namespace galactic
