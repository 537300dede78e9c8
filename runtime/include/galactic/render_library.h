#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "galactic/error.h"
#include "galactic/pack.h"
#include "galactic/render_meshes.h"

namespace galactic {

/// The textures of texture packs, found by their content. Movable; immutable once filled, and then
/// safe to share between threads.
class SharedTextures {
 public:
  /// Adds the texture of `pack`, which must outlive this. Fails with kInvalidInput if it is another
  /// kind of pack.
  [[nodiscard]] Result<void> add(const PackFile& pack);

  /// The texture whose texels have this XXH3-128 hash; null if there is none.
  [[nodiscard]] const RenderTexture* find(std::uint64_t hash_low, std::uint64_t hash_high) const;

 private:
  std::map<std::pair<std::uint64_t, std::uint64_t>, RenderTexture> by_hash_;
};

/// The path of the pack of a texture that `pack` shares: HASH.pack in the folder "textures" beside
/// the folder of `pack`. galactic-bake puts it there, and programs that have no list of packs look
/// for it there.
[[nodiscard]] std::filesystem::path texturePackBeside(const PackFile& pack,
                                                      const MissingTexture& texture);

/// The models of several packs, numbered together: what a renderer loads once for all envs. Copies
/// refer to the same memory. Immutable once filled, and then safe to share between threads.
class RenderLibrary {
 public:
  /// One model of one pack.
  struct Entry {
    /// Index into packs().
    std::uint32_t pack = 0;
    /// Index into that pack's models.
    std::uint32_t model = 0;
  };

  /// Adds all models of a pack, whose memory must outlive the library and its copies, or be kept by
  /// them (keep()). Returns the number of the first model; the others follow in order. `prefix` is
  /// put before the names of the pack's semantic ids.
  std::uint32_t add(RenderMeshes meshes, const std::string& prefix = {});
  /// Keeps the memory that meshes refer to for as long as this library or a copy of it lives.
  void keep(std::shared_ptr<const void> memory) { kept_.push_back(std::move(memory)); }

  [[nodiscard]] const std::vector<RenderMeshes>& packs() const { return packs_; }
  [[nodiscard]] std::size_t modelCount() const { return entries_.size(); }
  [[nodiscard]] const Entry& entry(std::uint32_t model) const { return entries_[model]; }
  [[nodiscard]] const RenderModel& model(std::uint32_t model) const {
    const Entry& entry = entries_[model];
    return packs_[entry.pack].models[entry.model];
  }
  /// A pack's semantic id becomes firstSemantic(pack) + id in images.
  [[nodiscard]] std::uint32_t firstSemantic(std::size_t pack) const {
    return first_semantics_[pack];
  }
  /// Names, indexed by the ids in images; 0 is the background.
  [[nodiscard]] const std::vector<std::string>& semanticNames() const { return semantic_names_; }

 private:
  std::vector<std::shared_ptr<const void>> kept_;
  std::vector<RenderMeshes> packs_;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> first_semantics_;
  std::vector<std::string> semantic_names_{"background"};
};

}  // namespace galactic
