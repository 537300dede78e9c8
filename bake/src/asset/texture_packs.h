#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>

#include "galactic/error.h"

namespace galactic::bake {

/// Keeps track of which texture packs, shared between scenes, exist and are intact. A pack is read
/// at most once, however many scenes show it, and not at all if this run made it. Thread-safe.
class TexturePacks {
 public:
  /// Whether `pack` exists and is intact. If not, the next call looks again, because another bake
  /// may have made it meanwhile.
  [[nodiscard]] bool isWhole(const std::filesystem::path& pack);

  /// Calls `make` to create the pack unless it exists and is intact. Other threads that want the
  /// pack wait, so `make` must not ask for it. Fails with the error of `make`.
  [[nodiscard]] Result<void> provide(const std::filesystem::path& pack,
                                     const std::function<Result<void>()>& make);

 private:
  struct Entry {
    std::mutex mutex;
    bool is_whole = false;
  };

  [[nodiscard]] Entry& entryOf(const std::filesystem::path& pack);

  std::mutex mutex_;
  std::map<std::filesystem::path, Entry> entries_;
};

}  // namespace galactic::bake
