#include "textures/images/transfer_function.h"

#include "common/srgb.h"

namespace galactic::bake {

TransferFunction::TransferFunction() {
  for (std::size_t byte = 0; byte < linear_.size(); ++byte) {
    linear_[byte] = static_cast<float>(srgbDecoded(static_cast<double>(byte) / 255));
    least_[byte] =
        byte == 0 ? 0.F : static_cast<float>(srgbDecoded((static_cast<double>(byte) - 0.5) / 255));
  }
  std::uint8_t byte = 0;
  for (std::size_t bin = 0; bin < at_bin_.size(); ++bin) {
    const float low = static_cast<float>(bin) / static_cast<float>(kBins);
    while (byte < 255 && low >= least_[byte + 1U]) ++byte;
    at_bin_[bin] = byte;
  }
}

std::uint8_t TransferFunction::encoded(float linear) const {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 255;
  std::uint8_t byte = at_bin_[static_cast<std::size_t>(linear * static_cast<float>(kBins))];
  while (byte < 255 && linear >= least_[byte + 1U]) ++byte;
  return byte;
}

}  // namespace galactic::bake
