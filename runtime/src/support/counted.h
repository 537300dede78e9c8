#pragma once
#include <concepts>
#include <string>
#include <string_view>

namespace galactic {

/// How many there are, in words: "1 mesh", "3 meshes". `one` is an English noun that takes an s, or
/// es behind s, x, ch and sh.
[[nodiscard]] std::string counted(std::integral auto count, std::string_view one) {
  std::string text = std::to_string(count);
  text.append(1, ' ').append(one);
  if (count == 1) return text;
  const bool hisses =
      one.ends_with('s') || one.ends_with('x') || one.ends_with("ch") || one.ends_with("sh");
  return text.append(hisses ? "es" : "s");
}

}  // namespace galactic
