#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/render_meshes.h"

namespace galactic {

/// The models of several packs under one numbering: what a renderer loads once for all envs.
/// Movable; immutable once filled, so then safe to share between threads.
class RenderLibrary {
 public:
  /// One model of one pack.
  struct Entry {
    /// Index into packs().
    std::uint32_t pack = 0;
    /// Index into its models.
    std::uint32_t model = 0;
  };

  /// Adds all models of a pack, whose memory must outlive the library. Returns the number of the
  /// first; the others follow in their order. `prefix` stands before the names of its semantics.
  std::uint32_t add(RenderMeshes meshes, const std::string& prefix = {});

  [[nodiscard]] const std::vector<RenderMeshes>& packs() const { return packs_; }
  [[nodiscard]] std::size_t modelCount() const { return entries_.size(); }
  [[nodiscard]] const Entry& entry(std::uint32_t model) const { return entries_[model]; }
  [[nodiscard]] const RenderModel& model(std::uint32_t model) const {
    const Entry& entry = entries_[model];
    return packs_[entry.pack].models[entry.model];
  }
  /// What a semantic id of a pack becomes in images: firstSemantic(pack) + id.
  [[nodiscard]] std::uint32_t firstSemantic(std::size_t pack) const {
    return first_semantics_[pack];
  }
  /// Names by the ids in images; 0 is the background.
  [[nodiscard]] const std::vector<std::string>& semanticNames() const { return semantic_names_; }

 private:
  std::vector<RenderMeshes> packs_;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> first_semantics_;
  std::vector<std::string> semantic_names_{"background"};
};

}  // namespace galactic
