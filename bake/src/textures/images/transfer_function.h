#pragma once
#include <array>
#include <cstdint>

namespace galactic::bake {

/// Tables of the sRGB transfer function (IEC 61966-2-1) between bytes and linear light.
class TransferFunction {
 public:
  TransferFunction();

  /// The linear value of a byte, 0 to 1.
  [[nodiscard]] float linear(std::uint8_t byte) const { return linear_[byte]; }
  /// The nearest byte, as measured in sRGB. Values outside 0 to 1 are clamped; NaN becomes 0.
  [[nodiscard]] std::uint8_t encoded(float linear) const;

 private:
  static constexpr std::size_t kBins = 1024;

  std::array<float, 256> linear_{};
  /// Element b is the least linear value that encodes to at least byte b.
  std::array<float, 256> least_{};
  /// The byte at the lower end of each bin; the bins divide 0 to 1.
  std::array<std::uint8_t, kBins + 1> at_bin_{};
};

}  // namespace galactic::bake
