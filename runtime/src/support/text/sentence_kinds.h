#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace galactic {

/// Shortens a list of sentences: for many of a kind (the same but for names in quotes and numbers),
/// returns the first of them, how many more there are, and `who_lists_them`: "-v lists them". Kinds
/// appear in the order of their first sentences.
[[nodiscard]] std::vector<std::string> oneOfEachKind(const std::vector<std::string>& sentences,
                                                     std::string_view who_lists_them);

}  // namespace galactic
