#include "policy/packed_product.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace galactic::policy {
namespace {

std::size_t packs(std::size_t outputs) { return (outputs + kPack - 1) / kPack; }

}  // namespace

PackedProduct::PackedProduct(std::size_t outputs, const RowLayout& layout)
    : outputs_(outputs),
      layout_(layout),
      weights_(packs(outputs) * kPack * layout.terms()),
      bias_(packs(outputs) * kPack) {}

void PackedProduct::setWeight(std::size_t output, std::size_t term, float weight) {
  const std::size_t first = output / kPack * kPack * layout_.terms();
  weights_.data()[first + term * kPack + output % kPack] = weight;
}

void PackedProduct::setBias(std::size_t output, float bias) { bias_.data()[output] = bias; }

void PackedProduct::multiply(const Kernels& kernels, std::span<const float* const> rows,
                             std::span<float* const> results) const noexcept {
  assert(rows.size() == results.size() && rows.size() <= kRows);
  std::array<float*, kRows> part{};
  std::ranges::copy(results, part.begin());
  Product product{.rows = rows.data(),
                  .results = part.data(),
                  .row_count = rows.size(),
                  .runs = layout_.runs,
                  .run_length = layout_.run_length,
                  .run_stride = layout_.run_stride,
                  .weights = weights_.data(),
                  .bias = bias_.data(),
                  .outputs = 0};
  for (std::size_t first = 0; first < outputs_; first += kPack) {
    product.outputs = std::min(kPack, outputs_ - first);
    kernels.multiply(product);
    product.weights += kPack * layout_.terms();
    product.bias += kPack;
    for (std::size_t r = 0; r < rows.size(); ++r) part[r] += kPack;
  }
}

}  // namespace galactic::policy
