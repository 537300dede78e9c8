#include "textures/images/linear_image.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace galactic::bake {
namespace {

/// For each texel in a row of the result, the source texels that it is computed from and their
/// weights.
class Taps {
 public:
  Taps(std::uint32_t source, std::uint32_t result) {
    ends_.reserve(result);
    first_.reserve(result);
    for (std::uint32_t i = 0; i < result; ++i) {
      if (source > result) {
        addArea(i, source, result);
      } else {
        addLinear(i, source, result);
      }
      ends_.push_back(weights_.size());
    }
  }

  [[nodiscard]] std::uint32_t first(std::size_t texel) const { return first_[texel]; }
  [[nodiscard]] std::span<const float> weights(std::size_t texel) const {
    const std::size_t begin = texel == 0 ? 0 : ends_[texel - 1];
    return std::span(weights_).subspan(begin, ends_[texel] - begin);
  }

 private:
  /// Texel i covers i * source / result to (i + 1) * source / result. Computed exactly, in units of
  /// 1 / result.
  void addArea(std::uint64_t i, std::uint64_t source, std::uint64_t result) {
    const std::uint64_t begin = i * source;
    const std::uint64_t end = begin + source;
    first_.push_back(static_cast<std::uint32_t>(begin / result));
    for (std::uint64_t texel = begin / result; texel * result < end; ++texel) {
      const std::uint64_t covered =
          std::min(end, (texel + 1) * result) - std::max(begin, texel * result);
      weights_.push_back(
          static_cast<float>(static_cast<double>(covered) / static_cast<double>(source)));
    }
  }

  /// Equal sizes give a single weight of 1.
  void addLinear(std::uint32_t i, std::uint32_t source, std::uint32_t result) {
    const double center = (i + 0.5) * source / result - 0.5;
    const double clamped = std::clamp(center, 0.0, static_cast<double>(source - 1));
    const auto texel = static_cast<std::uint32_t>(clamped);
    const auto part = static_cast<float>(clamped - texel);
    first_.push_back(texel);
    weights_.push_back(1 - part);
    if (part > 0) weights_.push_back(part);
  }

  std::vector<std::uint32_t> first_;
  std::vector<std::size_t> ends_;
  std::vector<float> weights_;
};

void addScaled(LinearTexel& sum, const LinearTexel& texel, float weight) {
  for (std::size_t channel = 0; channel < 4; ++channel) sum[channel] += weight * texel[channel];
}

void readRow(std::span<const std::uint8_t> rgba, AlphaUse alpha, const TransferFunction& transfer,
             std::span<LinearTexel> row) {
  for (std::size_t x = 0; x < row.size(); ++x) {
    const std::uint8_t* texel = &rgba[4 * x];
    const float a = alpha == AlphaUse::kIgnored ? 1.F : static_cast<float>(texel[3]) / 255.F;
    row[x] = {transfer.linear(texel[0]) * a, transfer.linear(texel[1]) * a,
              transfer.linear(texel[2]) * a, a};
  }
}

}  // namespace

LinearImage resampled(const Image& image, std::uint32_t size, AlphaUse alpha,
                      const TransferFunction& transfer) {
  const Taps across(image.width, size);
  const Taps down(image.height, size);
  std::vector<LinearTexel> row(image.width);
  std::vector<LinearTexel> narrow(std::size_t{image.height} * size, LinearTexel{});
  const std::size_t row_bytes = std::size_t{image.width} * 4;
  for (std::size_t y = 0; y < image.height; ++y) {
    readRow(std::span(image.rgba).subspan(y * row_bytes, row_bytes), alpha, transfer, row);
    for (std::size_t x = 0; x < size; ++x) {
      const auto weights = across.weights(x);
      LinearTexel& sum = narrow[y * size + x];
      for (std::size_t k = 0; k < weights.size(); ++k) {
        addScaled(sum, row[across.first(x) + k], weights[k]);
      }
    }
  }
  LinearImage result{.size = size,
                     .texels = std::vector<LinearTexel>(std::size_t{size} * size, LinearTexel{})};
  for (std::size_t y = 0; y < size; ++y) {
    const auto weights = down.weights(y);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const LinearTexel* from = &narrow[(down.first(y) + k) * size];
      for (std::size_t x = 0; x < size; ++x) {
        addScaled(result.texels[y * size + x], from[x], weights[k]);
      }
    }
  }
  return result;
}

LinearImage halved(const LinearImage& image) {
  const std::size_t size = image.size / 2;
  LinearImage result{.size = image.size / 2, .texels = std::vector<LinearTexel>(size * size)};
  for (std::size_t y = 0; y < size; ++y) {
    const LinearTexel* upper = &image.texels[2 * y * image.size];
    const LinearTexel* lower = upper + image.size;
    for (std::size_t x = 0; x < size; ++x) {
      for (std::size_t c = 0; c < 4; ++c) {
        result.texels[y * size + x][c] = 0.25F * ((upper[2 * x][c] + upper[2 * x + 1][c]) +
                                                  (lower[2 * x][c] + lower[2 * x + 1][c]));
      }
    }
  }
  return result;
}

}  // namespace galactic::bake
