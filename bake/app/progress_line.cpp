#include "progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace galactic::bake {

ProgressLine::ProgressLine(bool wanted) : enabled_(wanted && ::isatty(STDERR_FILENO) == 1) {}

void ProgressLine::show(std::string_view item, std::string_view stage, double fraction) {
  if (!enabled_) return;
  constexpr int kWidth = 20;
  const int done = static_cast<int>(fraction * kWidth);
  const std::string bar = std::string(static_cast<std::size_t>(done), '=') +
                          std::string(static_cast<std::size_t>(kWidth - done), ' ');
  fmt::print(stderr, "\r\033[K[{}] {}: {}", bar, item, stage);
  std::fflush(stderr);
  shown_ = true;
}

void ProgressLine::clear() {
  if (!shown_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace galactic::bake
