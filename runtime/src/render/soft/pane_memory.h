#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/soft/pane.h"

namespace galactic::render {

/// What one thread needs to draw panes of a size: allocated once, apart from the room for clusters,
/// which grows to the largest view seen.
class PaneMemory {
 public:
  /// Pixels of the largest pane, at most kPaneEdge each.
  PaneMemory(std::uint32_t width, std::uint32_t height);
  ~PaneMemory();
  PaneMemory(const PaneMemory&) = delete;
  PaneMemory& operator=(const PaneMemory&) = delete;

  /// Makes room for views of so many models and clusters.
  void reserve(std::size_t models, std::size_t clusters);

  [[nodiscard]] const PaneScratch& scratch() const { return scratch_; }
  [[nodiscard]] PlacedModel* models() { return models_.data(); }

  /// What the thread did in this batch.
  PaneCounts counts;

 private:
  std::byte* block_ = nullptr;
  std::size_t block_bytes_ = 0;
  std::vector<SeenCluster> seen_;
  std::vector<std::uint32_t> order_;
  std::vector<PlacedModel> models_;
  PaneScratch scratch_;
};

}  // namespace galactic::render
