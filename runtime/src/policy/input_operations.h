#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "galactic/schema/pack_generated.h"
#include "policy/operation.h"

namespace galactic::policy {

// The layers without inputs, which a network begins with.

/// A copy of stored weights.
[[nodiscard]] inline std::vector<float> copyOf(const flatbuffers::Vector<float>& stored) {
  return {stored.begin(), stored.end()};
}

class ObservationOperation final : public Operation {
 public:
  ObservationOperation(BufferId to, std::span<const ObservationRange> ranges) : to_(to) {
    for (const ObservationRange& range : ranges) {
      const bool joins =
          !ranges_.empty() && ranges_.back().first + ranges_.back().size == range.first;
      if (joins) {
        ranges_.back().size += range.size;
      } else {
        ranges_.push_back(range);
      }
    }
  }

  void run(const Tile& tile) const noexcept override {
    for (std::size_t n = 0; n < tile.count; ++n) {
      const float* row =
          tile.inputs->observations + (tile.first_env + n) * tile.inputs->observation_size;
      float* to = tile.value(to_, n);
      for (const ObservationRange& range : ranges_) {
        to = std::copy_n(row + range.first, range.size, to);
      }
    }
  }

 private:
  BufferId to_;
  std::vector<ObservationRange> ranges_;
};

class PreviousActionOperation final : public Operation {
 public:
  explicit PreviousActionOperation(BufferId to) : to_(to) {}

  void run(const Tile& tile) const noexcept override {
    const std::size_t count = tile.inputs->action_count;
    for (std::size_t n = 0; n < tile.count; ++n) {
      std::copy_n(tile.inputs->previous_actions + (tile.first_env + n) * count, count,
                  tile.value(to_, n));
    }
  }

 private:
  BufferId to_;
};

/// Converts bytes and meters to numbers, pixel by pixel.
class ImageOperation final : public Operation {
 public:
  ImageOperation(BufferId to, const schema::PolicyImage& image)
      : to_(to),
        pixels_(std::size_t{image.width()} * image.height()),
        color_(image.color()),
        color_scale_(image.color_scale()),
        depth_(image.depth()),
        depth_limit_(image.depth_limit()),
        depth_scale_(image.depth_scale()) {}

  void run(const Tile& tile) const noexcept override {
    for (std::size_t n = 0; n < tile.count; ++n) {
      const std::size_t env = tile.first_env + n;
      if (color_) convertColor(*tile.inputs, env, tile.value(to_, n));
      if (depth_) convertDepth(*tile.inputs, env, tile.value(to_, n));
    }
  }

 private:
  [[nodiscard]] std::size_t channels() const { return (color_ ? 3U : 0U) + (depth_ ? 1U : 0U); }

  void convertColor(const NetworkInputs& inputs, std::size_t env, float* to) const noexcept {
    const std::uint8_t* from = inputs.color + env * pixels_ * inputs.color_bytes;
    const std::size_t step = channels();
    for (std::size_t p = 0; p < pixels_; ++p, from += inputs.color_bytes, to += step) {
      to[0] = static_cast<float>(from[0]) * color_scale_;
      to[1] = static_cast<float>(from[1]) * color_scale_;
      to[2] = static_cast<float>(from[2]) * color_scale_;
    }
  }

  void convertDepth(const NetworkInputs& inputs, std::size_t env, float* to) const noexcept {
    const float* from = inputs.depth + env * pixels_;
    const std::size_t step = channels();
    to += step - 1;
    for (std::size_t p = 0; p < pixels_; ++p, to += step) {
      *to = std::min(from[p], depth_limit_) * depth_scale_;
    }
  }

  BufferId to_;
  std::size_t pixels_;
  bool color_;
  float color_scale_;
  bool depth_;
  float depth_limit_;
  float depth_scale_;
};

class ConstantOperation final : public Operation {
 public:
  ConstantOperation(BufferId to, const flatbuffers::Vector<float>& values)
      : to_(to), values_(copyOf(values)) {}

  void run(const Tile& tile) const noexcept override {
    for (std::size_t n = 0; n < tile.count; ++n) std::ranges::copy(values_, tile.value(to_, n));
  }

 private:
  BufferId to_;
  std::vector<float> values_;
};

}  // namespace galactic::policy
