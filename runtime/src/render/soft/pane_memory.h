#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/soft/pane.h"

namespace galactic::render {

/// The memory that one thread needs to draw panes of up to a given size. It is allocated once,
/// except for models and clusters, whose room grows to the largest view so far.
class PaneMemory {
 public:
  /// `width`, `height`: of the largest pane, pixels, at most kPaneEdge each.
  PaneMemory(std::uint32_t width, std::uint32_t height);
  ~PaneMemory();
  PaneMemory(const PaneMemory&) = delete;
  PaneMemory& operator=(const PaneMemory&) = delete;

  /// Makes room for views of up to this many models and clusters.
  void reserve(std::size_t models, std::size_t clusters);

  [[nodiscard]] const PaneScratch& scratch() const { return scratch_; }
  [[nodiscard]] PlacedModel* models() { return models_.data(); }

  /// What the thread has drawn in this batch.
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
