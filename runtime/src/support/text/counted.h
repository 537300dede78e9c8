#pragma once
#include <concepts>
#include <string>
#include <string_view>

namespace galactic {

/// The noun in the singular or plural, as `count` requires. `one` is English and takes an s, or es
/// after s, x, ch and sh; nouns in -ex, such as vertex and index, become vertices and indices.
[[nodiscard]] std::string nounFor(std::integral auto count, std::string_view one) {
  std::string noun(one);
  if (count == 1) return noun;
  if (one.ends_with("ex")) return noun.replace(noun.size() - 2, 2, "ices");
  const bool hisses =
      one.ends_with('s') || one.ends_with('x') || one.ends_with("ch") || one.ends_with("sh");
  return noun.append(hisses ? "es" : "s");
}

/// A count in words: "1 mesh", "3 meshes".
[[nodiscard]] std::string counted(std::integral auto count, std::string_view one) {
  return std::to_string(count) + " " + nounFor(count, one);
}

}  // namespace galactic
