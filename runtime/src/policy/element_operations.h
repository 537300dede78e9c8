#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "galactic/schema/pack_generated.h"
#include "policy/input_operations.h"
#include "policy/operation.h"

namespace galactic::policy {

// Layers that take values as they are: element by element, by channel, or one after another.

class NormalizeOperation final : public Operation {
 public:
  NormalizeOperation(BufferId from, BufferId to, const LayerShape& shape,
                     const schema::NormalizeLayer& layer)
      : from_(from),
        to_(to),
        pixels_(shape.pixels()),
        mean_(copyOf(*layer.mean())),
        inverse_deviation_(copyOf(*layer.inverse_deviation())),
        limit_(layer.limit()) {}

  void run(const Tile& tile) const noexcept override {
    const std::size_t channels = mean_.size();
    for (std::size_t n = 0; n < tile.count; ++n) {
      const float* from = tile.value(from_, n);
      float* to = tile.value(to_, n);
      for (std::size_t p = 0; p < pixels_; ++p, from += channels, to += channels) {
        for (std::size_t c = 0; c < channels; ++c) {
          to[c] = std::clamp((from[c] - mean_[c]) * inverse_deviation_[c], -limit_, limit_);
        }
      }
    }
  }

 private:
  BufferId from_;
  BufferId to_;
  std::size_t pixels_;
  std::vector<float> mean_;
  std::vector<float> inverse_deviation_;
  float limit_;
};

class ClampOperation final : public Operation {
 public:
  ClampOperation(BufferId from, BufferId to, const LayerShape& shape,
                 const schema::ClampLayer& layer)
      : from_(from), to_(to), size_(shape.size()), lower_(layer.lower()), upper_(layer.upper()) {}

  void run(const Tile& tile) const noexcept override {
    for (std::size_t n = 0; n < tile.count; ++n) {
      const float* from = tile.value(from_, n);
      std::transform(from, from + size_, tile.value(to_, n),
                     [this](float x) { return std::clamp(x, lower_, upper_); });
    }
  }

 private:
  BufferId from_;
  BufferId to_;
  std::size_t size_;
  float lower_;
  float upper_;
};

/// Applies a kernel to each element.
class ElementOperation final : public Operation {
 public:
  using Kernel = void (*Kernels::*)(const float*, float*, std::size_t) noexcept;

  ElementOperation(BufferId from, BufferId to, const LayerShape& shape, Kernel kernel)
      : from_(from), to_(to), size_(shape.size()), kernel_(kernel) {}

  void run(const Tile& tile) const noexcept override {
    for (std::size_t n = 0; n < tile.count; ++n) {
      (tile.kernels->*kernel_)(tile.value(from_, n), tile.value(to_, n), size_);
    }
  }

 private:
  BufferId from_;
  BufferId to_;
  std::size_t size_;
  Kernel kernel_;
};

class SumOperation final : public Operation {
 public:
  SumOperation(std::array<BufferId, 2> from, BufferId to, const LayerShape& shape)
      : from_(from), to_(to), size_(shape.size()) {}

  void run(const Tile& tile) const noexcept override {
    for (std::size_t n = 0; n < tile.count; ++n) {
      tile.kernels->add(tile.value(from_[0], n), tile.value(from_[1], n), tile.value(to_, n),
                        size_);
    }
  }

 private:
  std::array<BufferId, 2> from_;
  BufferId to_;
  std::size_t size_;
};

class ConcatenateOperation final : public Operation {
 public:
  struct Part {
    BufferId from = 0;
    std::size_t size = 0;
  };

  ConcatenateOperation(std::vector<Part> parts, BufferId to) : parts_(std::move(parts)), to_(to) {}

  void run(const Tile& tile) const noexcept override {
    for (std::size_t n = 0; n < tile.count; ++n) {
      float* to = tile.value(to_, n);
      for (const Part& part : parts_) to = std::copy_n(tile.value(part.from, n), part.size, to);
    }
  }

 private:
  std::vector<Part> parts_;
  BufferId to_;
};

class SliceOperation final : public Operation {
 public:
  SliceOperation(BufferId from, BufferId to, const schema::SliceLayer& layer)
      : from_(from), to_(to), first_(layer.first()), size_(layer.size()) {}

  void run(const Tile& tile) const noexcept override {
    for (std::size_t n = 0; n < tile.count; ++n) {
      std::copy_n(tile.value(from_, n) + first_, size_, tile.value(to_, n));
    }
  }

 private:
  BufferId from_;
  BufferId to_;
  std::size_t first_;
  std::size_t size_;
};

/// Normalizes images by groups, and vectors as a single group.
class NormOperation final : public Operation {
 public:
  template <class Layer>
  NormOperation(BufferId from, BufferId to, BufferId scratch, const LayerShape& shape,
                const Layer& layer, std::size_t groups)
      : from_(from),
        to_(to),
        scratch_(scratch),
        shape_(shape),
        groups_(groups),
        epsilon_(layer.epsilon()),
        weight_(copyOf(*layer.weight())),
        bias_(copyOf(*layer.bias())) {}

  void run(const Tile& tile) const noexcept override {
    for (std::size_t n = 0; n < tile.count; ++n) {
      tile.kernels->normalizeGroups({.from = tile.value(from_, n),
                                     .to = tile.value(to_, n),
                                     .pixels = shape_.pixels(),
                                     .channels = shape_.channels,
                                     .groups = groups_,
                                     .epsilon = epsilon_,
                                     .weight = weight_.data(),
                                     .bias = bias_.data(),
                                     .scratch = tile.value(scratch_, n)});
    }
  }

 private:
  BufferId from_;
  BufferId to_;
  BufferId scratch_;
  LayerShape shape_;
  std::size_t groups_;
  float epsilon_;
  std::vector<float> weight_;
  std::vector<float> bias_;
};

}  // namespace galactic::policy
