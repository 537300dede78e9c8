#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace galactic::test {

/// Takes values from a fuzzer's input; zeros after its end.
class Input {
 public:
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  [[nodiscard]] bool isEmpty() const { return bytes_.empty(); }

  template <class T>
  T take() {
    T value{};
    const std::size_t size = std::min(sizeof(T), bytes_.size());
    std::copy_n(bytes_.begin(), size, reinterpret_cast<std::uint8_t*>(&value));
    bytes_ = bytes_.subspan(size);
    return value;
  }

  /// Any bits, or, so that robots get somewhere, one of 255 values in [-1, 1].
  float action() {
    const auto first = take<std::int8_t>();
    return first == -128 ? take<float>() : static_cast<float>(first) / 127;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace galactic::test
