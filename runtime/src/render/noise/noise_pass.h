#pragma once
#include <atomic>
#include <cstddef>
#include <span>

#include "galactic/batch_renderer.h"
#include "support/threads/workers.h"

namespace galactic::render {

/// Adds RenderOptions::noise to images that have been drawn, whatever drew them: on all threads,
/// image by image.
class NoisePass {
 public:
  /// The options are within range; some noise is on.
  explicit NoisePass(const RenderOptions& options);

  /// `targets`: images of `views`.
  void run(std::span<const RenderView> views, const RenderTargets& targets) noexcept;

 private:
  void addToImages() noexcept;
  void addTo(std::size_t image) const noexcept;

  RenderOptions options_;
  bool has_avx2_;

  /// Of the batch in work.
  std::span<const RenderView> views_;
  RenderTargets targets_;
  std::atomic<std::size_t> next_{0};

  /// Last, so that its threads end before what they use.
  detail::Workers workers_;
};

}  // namespace galactic::render
