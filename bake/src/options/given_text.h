#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "galactic/bake/option_field.h"

namespace galactic::bake {

// Helpers shared by the fields of options.

template <class T>
[[nodiscard]] std::span<const std::byte> memoryOf(const T& field) {
  return std::as_bytes(std::span(&field, 1));
}

/// A word as it would be typed. Numbers become the shortest text that reads back as the same
/// number.
[[nodiscard]] inline std::string textOf(const GivenWord& word) {
  return std::visit(
      [](const auto& value) -> std::string {
        if constexpr (std::is_same_v<decltype(value), const std::string&>) {
          return value;
        } else {
          return fmt::format("{}", value);
        }
      },
      word);
}

[[nodiscard]] inline std::string textOf(const GivenValue& value) {
  std::vector<std::string> words;
  words.reserve(value.words.size());
  for (const GivenWord& word : value.words) words.push_back(textOf(word));
  return fmt::format("{}{}{}", value.name, value.name.empty() ? "" : "=", fmt::join(words, ","));
}

[[nodiscard]] inline std::string found(std::string_view shown, std::string_view expected) {
  return fmt::format("found {}, expected {}", shown, expected);
}

}  // namespace galactic::bake
