#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>

namespace galactic::policy {

/// A fixed number of floats that begin at a cache line; initially zero.
class AlignedFloats {
 public:
  AlignedFloats() = default;
  explicit AlignedFloats(std::size_t size)
      : size_(size), block_(static_cast<float*>(::operator new(size * sizeof(float), kAlignment))) {
    std::fill_n(block_.get(), size, 0.0F);
  }

  [[nodiscard]] float* data() { return block_.get(); }
  [[nodiscard]] const float* data() const { return block_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  static constexpr std::align_val_t kAlignment{64};
  struct Free {
    void operator()(float* block) const { ::operator delete(block, kAlignment); }
  };

  std::size_t size_ = 0;
  std::unique_ptr<float, Free> block_;
};

}  // namespace galactic::policy
