#include "support/text/printable.h"

#include <algorithm>

namespace galactic {

std::string printable(std::string_view text) {
  constexpr unsigned char kFirstPrintable = 0x20;
  constexpr unsigned char kDelete = 0x7f;
  std::string shown(text);
  std::replace_if(
      shown.begin(), shown.end(),
      [](char character) {
        const auto code = static_cast<unsigned char>(character);
        return code < kFirstPrintable || code == kDelete;
      },
      '?');
  return shown;
}

}  // namespace galactic
