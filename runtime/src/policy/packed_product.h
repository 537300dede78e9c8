#pragma once
#include <cstddef>
#include <span>

#include "policy/aligned_floats.h"
#include "policy/kernels.h"

namespace galactic::policy {

/// How the terms of a product are laid out in each row.
struct RowLayout {
  std::size_t runs = 1;
  std::size_t run_length = 0;
  std::size_t run_stride = 0;

  [[nodiscard]] std::size_t terms() const { return runs * run_length; }
};

/// A matrix of weights with its bias, laid out for the kernel: in packs of kPack outputs, and term
/// by term within a pack.
class PackedProduct {
 public:
  /// Begins with all weights and biases zero.
  PackedProduct(std::size_t outputs, const RowLayout& layout);

  void setWeight(std::size_t output, std::size_t term, float weight);
  void setBias(std::size_t output, float bias);

  [[nodiscard]] std::size_t outputs() const { return outputs_; }
  /// Includes the padding.
  [[nodiscard]] std::size_t weightCount() const { return weights_.size() + bias_.size(); }

  /// `rows` and `results` have the same size, at most kRows.
  void multiply(const Kernels& kernels, std::span<const float* const> rows,
                std::span<float* const> results) const noexcept;

 private:
  std::size_t outputs_;
  RowLayout layout_;
  AlignedFloats weights_;
  AlignedFloats bias_;
};

}  // namespace galactic::policy
