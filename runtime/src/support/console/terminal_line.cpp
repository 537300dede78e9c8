#include "support/console/terminal_line.h"

#include <sys/ioctl.h>

namespace galactic {
namespace {

/// 0 if unknown.
std::size_t columnsOf(int file) {
  winsize size{};
  return ::ioctl(file, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

/// Whether a byte of UTF-8 continues a character.
bool goesOn(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

}  // namespace

std::string fittingLine(std::string text, int file) {
  const std::size_t columns = columnsOf(file);
  if (columns == 0) return text;
  // The last column stays free: some terminals begin a new line after it.
  std::size_t letters = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (goesOn(text[at])) continue;
    if (letters + 1 == columns) {
      text.resize(at);
      break;
    }
    ++letters;
  }
  return text;
}

}  // namespace galactic
