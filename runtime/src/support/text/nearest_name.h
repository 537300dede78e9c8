#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace galactic {

/// "did you mean 'a' or 'b'?" with the known names that are nearest to `name` (edit distance), or
/// "known are ..." when none is near. Deterministic: ties keep the order of `known`.
[[nodiscard]] std::string suggestNames(std::string_view name,
                                       const std::vector<std::string>& known);

/// `complaint` of a parser of command lines: options that it does not know with the nearest of
/// those that it knows; values that are missing, given twice or none of a list in our words.
[[nodiscard]] std::string withSuggestions(std::string_view complaint,
                                          const std::vector<std::string>& known);

}  // namespace galactic
