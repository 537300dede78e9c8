#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace galactic::bake {

/// "did you mean 'a' or 'b'?" with the known names that are nearest to `name` (edit distance), or
/// "known are ..." when none is near. Deterministic: ties keep the order of `known`.
[[nodiscard]] std::string suggestNames(std::string_view name,
                                       const std::vector<std::string>& known);

}  // namespace galactic::bake
