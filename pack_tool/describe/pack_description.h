#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "galactic/pack.h"

namespace galactic::pack_tool {

/// JSON whose keys keep the order in which they were added.
using Json = nlohmann::ordered_json;

/// A float as the shortest decimal that reads back to exactly this float; null when not finite.
[[nodiscard]] Json jsonNumber(float value);

/// Indented text, closed by a newline. Bytes that are no UTF-8 are replaced by U+FFFD.
[[nodiscard]] std::string jsonText(const Json& json);

/// How much a description tells.
enum class Detail {
  kEverything,
  kSummary,  ///< What a summary for people needs: without the list of episodes.
};

/// Everything that `galactic-pack info` tells about a pack. The keys and their order are described
/// in pack_tool/README.md and stay as they are; new ones may be added.
[[nodiscard]] Json describePack(const PackFile& pack, Detail detail = Detail::kEverything);

}  // namespace galactic::pack_tool
