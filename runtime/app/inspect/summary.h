#pragma once
#include <string>
#include <string_view>

#include "galactic/pack.h"
#include "support/text/printable.h"

namespace galactic {

/// How long opening took, in seconds of wall-clock time.
struct OpenTimes {
  double map = 0;
  /// 0 if the pack was trusted.
  double verify = 0;
};

/// Describes a pack of any kind, how it was opened, and its warnings; lines of text, each ended by
/// a line break.
[[nodiscard]] std::string summarize(const PackFile& pack, const OpenTimes& times);

}  // namespace galactic
