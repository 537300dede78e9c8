#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>

#include "galactic/error.h"

namespace galactic::bake {

/// Texture packs that scenes share: which of them are there and whole. Each is read at most once,
/// however many scenes show it, or never where this run made it. Thread-safe.
class TexturePacks {
 public:
  /// One that is not is looked at again the next time: another bake may make it meanwhile.
  [[nodiscard]] bool isWhole(const std::filesystem::path& pack);

  /// Lets `make` put the pack there, unless it is there and whole. Whoever else wants the pack
  /// waits, so `make` must not ask for it. Fails with the error of `make`.
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
