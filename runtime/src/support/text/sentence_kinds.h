#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace galactic {

/// The sentences, or for many of a kind (the same but for names in quotes and numbers) the first of
/// them, how many more there are, and `who_lists_them`: "-v lists them". In the order of the first
/// of each kind.
[[nodiscard]] std::vector<std::string> oneOfEachKind(const std::vector<std::string>& sentences,
                                                     std::string_view who_lists_them);

}  // namespace galactic
