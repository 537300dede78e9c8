#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "policy/image_operations.h"
#include "policy/operation.h"
#include "policy/packed_product.h"

namespace galactic::policy {

// Layers that multiply; most of the time goes here.

/// Linear layers and convolutions: each place of the kernel is a row of the product.
class ProductOperation final : public Operation {
 public:
  ProductOperation(BufferId from, BufferId to, PackedProduct product, const Places& places)
      : from_(from), to_(to), product_(std::move(product)), places_(places) {}

  void run(const Tile& tile) const noexcept override {
    std::array<const float*, kRows> rows{};
    std::array<float*, kRows> results{};
    std::size_t filled = 0;
    const std::size_t places = places_.output.pixels();
    for (std::size_t n = 0; n < tile.count; ++n) {
      const float* from = tile.value(from_, n);
      float* to = tile.value(to_, n);
      for (std::size_t p = 0; p < places; ++p) {
        rows[filled] = from + places_.offset(p);
        results[filled] = to + p * product_.outputs();
        if (++filled < kRows) continue;
        product_.multiply(*tile.kernels, rows, results);
        filled = 0;
      }
    }
    product_.multiply(*tile.kernels, std::span(rows).first(filled),
                      std::span(results).first(filled));
  }
  [[nodiscard]] std::size_t weightCount() const noexcept override { return product_.weightCount(); }

 private:
  BufferId from_;
  BufferId to_;
  PackedProduct product_;
  Places places_;
};

/// What a gated recurrent unit needs in addition to its weights.
struct GruBuffers {
  BufferId from = 0;
  BufferId to = 0;
  /// The sums of the gates.
  BufferId input_sums = 0;
  BufferId state_sums = 0;
  /// Offset of its state in the state of an env.
  std::size_t state = 0;
};

class GruOperation final : public Operation {
 public:
  GruOperation(const GruBuffers& buffers, PackedProduct input, PackedProduct state)
      : buffers_(buffers), input_(std::move(input)), state_(std::move(state)) {}

  void run(const Tile& tile) const noexcept override {
    multiplyAll(tile);
    const std::size_t size = input_.outputs() / 3;
    for (std::size_t n = 0; n < tile.count; ++n) {
      float* state = tile.state(n) + buffers_.state;
      float* to = tile.value(buffers_.to, n);
      tile.kernels->gate({.input = tile.value(buffers_.input_sums, n),
                          .recurrent = tile.value(buffers_.state_sums, n),
                          .state = state,
                          .to = to,
                          .size = size});
      std::copy_n(to, size, state);
    }
  }
  [[nodiscard]] std::size_t weightCount() const noexcept override {
    return input_.weightCount() + state_.weightCount();
  }

 private:
  void multiplyAll(const Tile& tile) const noexcept {
    std::array<const float*, kRows> inputs{};
    std::array<const float*, kRows> states{};
    std::array<float*, kRows> input_sums{};
    std::array<float*, kRows> state_sums{};
    for (std::size_t first = 0; first < tile.count; first += kRows) {
      const std::size_t count = std::min(kRows, tile.count - first);
      for (std::size_t n = 0; n < count; ++n) {
        inputs[n] = tile.value(buffers_.from, first + n);
        states[n] = tile.state(first + n) + buffers_.state;
        input_sums[n] = tile.value(buffers_.input_sums, first + n);
        state_sums[n] = tile.value(buffers_.state_sums, first + n);
      }
      input_.multiply(*tile.kernels, std::span(inputs).first(count),
                      std::span(input_sums).first(count));
      state_.multiply(*tile.kernels, std::span(states).first(count),
                      std::span(state_sums).first(count));
    }
  }

  GruBuffers buffers_;
  PackedProduct input_;
  PackedProduct state_;
};

}  // namespace galactic::policy
