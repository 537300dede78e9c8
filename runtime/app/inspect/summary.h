#pragma once
#include <string>
#include <string_view>

#include "galactic/pack.h"
#include "support/text/printable.h"

namespace galactic {

/// How long opening took, seconds of wall clock.
struct OpenTimes {
  double map = 0;
  /// 0 when the pack was trusted.
  double verify = 0;
};

/// What a pack of any kind is and how it opened, its warnings: lines of text, each ended.
[[nodiscard]] std::string summarize(const PackFile& pack, const OpenTimes& times);

}  // namespace galactic
