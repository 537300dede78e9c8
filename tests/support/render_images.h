#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

#include "galactic/batch_renderer.h"
#include "galactic/pose.h"

namespace galactic::test {

/// What a renderer made of some views.
struct RenderImages {
  std::vector<std::uint8_t> color;
  std::vector<float> depth;
  std::vector<std::uint32_t> semantics;

  friend bool operator==(const RenderImages&, const RenderImages&) = default;
};

/// Memory for the images of so many views, filled with what no renderer writes.
inline RenderImages emptyImages(const RenderOptions& options, std::size_t views) {
  const std::size_t pixels = views * options.width * options.height;
  RenderImages images;
  images.color.assign(pixels * static_cast<std::size_t>(options.color), 0xA5);
  if (options.depth) images.depth.assign(pixels, -7);
  if (options.semantics) images.semantics.assign(pixels, 0xA5A5A5A5);
  return images;
}

inline RenderTargets targetsOf(RenderImages& images) {
  return {images.color, images.depth, images.semantics};
}

inline BatchRenderer makeRenderer(const RenderLibrary& library, const RenderOptions& options) {
  Result<BatchRenderer> made = BatchRenderer::create(library, options);
  if (!made) throw std::runtime_error(made.error().message);
  return std::move(*made);
}

inline RenderImages renderViews(BatchRenderer& renderer, std::span<const RenderView> views) {
  RenderImages images = emptyImages(renderer.options(), views.size());
  renderer.render(views, targetsOf(images));
  return images;
}

inline RenderImages renderViews(const RenderLibrary& library, const RenderOptions& options,
                                std::span<const RenderView> views) {
  BatchRenderer renderer = makeRenderer(library, options);
  return renderViews(renderer, views);
}

/// In [lo, hi): the same on every standard library.
inline float uniform(std::mt19937& random, float lo, float hi) {
  const double share = static_cast<double>(random()) / 4294967296.0;
  return lo + static_cast<float>(share) * (hi - lo);
}

inline Quat randomRotation(std::mt19937& random) {
  Quat q;
  float square = 0;
  while (square < 0.01F || square > 1) {
    q = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1),
         uniform(random, -1, 1)};
    square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  }
  const float scale = 1 / std::sqrt(square);
  return {q.x * scale, q.y * scale, q.z * scale, q.w * scale};
}

inline float radians(float degrees) { return degrees * std::numbers::pi_v<float> / 180; }

}  // namespace galactic::test
