#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace galactic {

/// "did you mean 'a' or 'b'?" with the known names that are nearest to `name` (edit distance), or
/// "known are ..." when none is near. Deterministic: ties keep the order of `known`.
[[nodiscard]] std::string suggestNames(std::string_view name,
                                       const std::vector<std::string>& known);

/// Improves a `complaint` of a command-line parser: for an unknown option, adds the nearest known
/// ones; rewords complaints about values that are missing, given twice or not in a list.
[[nodiscard]] std::string withSuggestions(std::string_view complaint,
                                          const std::vector<std::string>& known);

}  // namespace galactic
