#pragma once
#include <filesystem>
#include <mutex>
#include <set>

#include "galactic/pack.h"

namespace galactic::bake {

/// Which texture packs are there and whole; each is read once, for many scenes show it.
/// Thread-safe.
class TextureChecks {
 public:
  [[nodiscard]] bool isWhole(const std::filesystem::path& pack) {
    {
      const std::lock_guard lock(mutex_);
      if (whole_.contains(pack)) return true;
    }
    // Those that are not are looked at again: another bake may make them meanwhile.
    const auto opened = PackFile::open(pack);
    if (!opened || opened->kind() != PackKind::kTexture) return false;
    const std::lock_guard lock(mutex_);
    whole_.insert(pack);
    return true;
  }

 private:
  std::mutex mutex_;
  std::set<std::filesystem::path> whole_;
};

}  // namespace galactic::bake
