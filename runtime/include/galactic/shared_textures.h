#pragma once
#include <cstdint>
#include <map>
#include <utility>

#include "galactic/error.h"
#include "galactic/pack.h"
#include "galactic/render_meshes.h"

namespace galactic {

/// The textures of texture packs, by content. Movable; immutable once filled, so then safe to share
/// between threads.
class SharedTextures {
 public:
  /// Adds the texture of `pack`, which must outlive this. Fails with kInvalidInput on another kind
  /// of pack.
  [[nodiscard]] Result<void> add(const PackFile& pack);

  /// The texture with this XXH3-128 of its texels; null when it is not there.
  [[nodiscard]] const RenderTexture* find(std::uint64_t hash_low, std::uint64_t hash_high) const;

 private:
  std::map<std::pair<std::uint64_t, std::uint64_t>, RenderTexture> by_hash_;
};

}  // namespace galactic
