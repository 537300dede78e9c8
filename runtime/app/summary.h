#pragma once
#include <string>
#include <string_view>

#include "galactic/pack.h"
#include "galactic/printable.h"
#include "galactic/scene.h"

namespace galactic {

/// How long opening took, seconds of wall clock.
struct OpenTimes {
  double map = 0;
  /// 0 when the pack was trusted.
  double verify = 0;
};

/// A table of what a scene pack holds, several lines of text, each ended.
[[nodiscard]] std::string summarise(const PackFile& pack, const Scene& scene,
                                    const OpenTimes& times);

}  // namespace galactic
