#include "pack_tool/support/console.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace galactic::pack_tool {

namespace {

std::size_t severity(int exit_code) {
  constexpr std::array kRising{kExitOk,
                               kExitDiffers,
                               static_cast<int>(ErrorCode::kUnsupported),
                               static_cast<int>(ErrorCode::kIo),
                               static_cast<int>(ErrorCode::kInvalidInput),
                               kExitUsage,
                               static_cast<int>(ErrorCode::kInternal)};
  return static_cast<std::size_t>(std::find(kRising.begin(), kRising.end(), exit_code) -
                                  kRising.begin());
}

}  // namespace

int reportError(const Console& console, const Error& error) {
  console.err << fmt::format("galactic-pack: {}: {}\n", printable(error.where),
                             printable(error.message));
  return static_cast<int>(error.code);
}

void reportWarning(const Console& console, const std::optional<std::string>& sentence) {
  if (!sentence) return;
  console.err << fmt::format("galactic-pack: warning: {}\n", printable(*sentence));
}

int worseExit(int a, int b) { return severity(a) < severity(b) ? b : a; }

}  // namespace galactic::pack_tool
