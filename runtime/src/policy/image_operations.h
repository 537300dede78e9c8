#pragma once
#include <algorithm>
#include <cstddef>

#include "policy/operation.h"

namespace galactic::policy {

// Layers that move pixels. Images are stored row by row, pixel by pixel, with all channels of a
// pixel together.

class SpaceToDepthOperation final : public Operation {
 public:
  SpaceToDepthOperation(BufferId from, BufferId to, const LayerShape& input, std::uint32_t block)
      : from_(from), to_(to), input_(input), block_(block) {}

  void run(const Tile& tile) const noexcept override {
    // Each row of a block is contiguous in both the input and the result.
    const std::size_t stretch = std::size_t{block_} * input_.channels;
    const std::size_t row = std::size_t{input_.width} * input_.channels;
    for (std::size_t n = 0; n < tile.count; ++n) {
      const float* from = tile.value(from_, n);
      float* to = tile.value(to_, n);
      for (std::size_t y = 0; y < input_.height; y += block_) {
        for (std::size_t x = 0; x < row; x += stretch) {
          for (std::size_t r = 0; r < block_; ++r) {
            to = std::copy_n(from + (y + r) * row + x, stretch, to);
          }
        }
      }
    }
  }

 private:
  BufferId from_;
  BufferId to_;
  LayerShape input_;
  std::uint32_t block_;
};

/// Surrounds an image with zeros.
class PadOperation final : public Operation {
 public:
  PadOperation(BufferId from, BufferId to, const LayerShape& input, std::uint32_t padding)
      : from_(from), to_(to), input_(input), padding_(padding) {}

  void run(const Tile& tile) const noexcept override {
    const std::size_t row = std::size_t{input_.width} * input_.channels;
    const std::size_t edge = std::size_t{padding_} * input_.channels;
    for (std::size_t n = 0; n < tile.count; ++n) {
      const float* from = tile.value(from_, n);
      float* to = tile.value(to_, n);
      to = std::fill_n(to, padding_ * (row + 2 * edge) + edge, 0.0F);
      for (std::size_t y = 0; y < input_.height; ++y) {
        to = std::copy_n(from + y * row, row, to);
        // The padding at the right edge and at the left edge of the next row.
        const bool is_last = y + 1 == input_.height;
        to = std::fill_n(to, is_last ? edge + padding_ * (row + 2 * edge) : 2 * edge, 0.0F);
      }
    }
  }

 private:
  BufferId from_;
  BufferId to_;
  LayerShape input_;
  std::uint32_t padding_;
};

/// The places of a kernel on an image, which includes its zero padding.
struct Places {
  LayerShape input;
  LayerShape output;
  std::uint32_t stride = 1;

  /// Offset of the first number under the kernel at place `n`.
  [[nodiscard]] std::size_t offset(std::size_t n) const {
    const std::size_t y = n / output.width * stride;
    const std::size_t x = n % output.width * stride;
    return (y * input.width + x) * input.channels;
  }
};

class AveragePoolOperation final : public Operation {
 public:
  AveragePoolOperation(BufferId from, BufferId to, const Places& places, std::uint32_t kernel)
      : from_(from), to_(to), places_(places), kernel_(kernel) {}

  void run(const Tile& tile) const noexcept override {
    for (std::size_t n = 0; n < tile.count; ++n) {
      const float* from = tile.value(from_, n);
      float* to = tile.value(to_, n);
      for (std::size_t p = 0; p < places_.output.pixels(); ++p, to += places_.output.channels) {
        average(from + places_.offset(p), to);
      }
    }
  }

 private:
  void average(const float* from, float* to) const noexcept {
    const std::size_t channels = places_.input.channels;
    const std::size_t row = places_.input.width * channels;
    std::fill_n(to, channels, 0.0F);
    for (std::size_t y = 0; y < kernel_; ++y) {
      for (std::size_t x = 0; x < kernel_; ++x) {
        const float* pixel = from + y * row + x * channels;
        for (std::size_t c = 0; c < channels; ++c) to[c] += pixel[c];
      }
    }
    const float count = static_cast<float>(kernel_) * static_cast<float>(kernel_);
    for (std::size_t c = 0; c < channels; ++c) to[c] /= count;
  }

  BufferId from_;
  BufferId to_;
  Places places_;
  std::uint32_t kernel_;
};

}  // namespace galactic::policy
