#pragma once
#include <atomic>
#include <cstddef>
#include <span>

#include "galactic/batch_renderer.h"
#include "support/threads/workers.h"

namespace galactic::render {

/// Adds RenderOptions::noise to images that any backend has drawn: on all threads, image by image.
class NoisePass {
 public:
  /// The options must be within range, with some noise on.
  explicit NoisePass(const RenderOptions& options);

  /// `targets`: the images of `views`.
  void run(std::span<const RenderView> views, const RenderTargets& targets) noexcept;

 private:
  void addToImages() noexcept;
  void addTo(std::size_t image) const noexcept;

  RenderOptions options_;
  bool has_avx2_;

  /// The batch that is being worked on.
  std::span<const RenderView> views_;
  RenderTargets targets_;
  std::atomic<std::size_t> next_{0};

  /// Comes last, so that its threads end before the members that they use.
  detail::Workers workers_;
};

}  // namespace galactic::render
