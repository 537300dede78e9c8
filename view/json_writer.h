#pragma once
#include <fmt/format.h>

#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace galactic {

/// Text as a JSON string; bytes that are no UTF-8 become question marks.
[[nodiscard]] std::string jsonString(std::string_view text);

enum class JsonLayout {
  kIndented,  ///< For people, closed by a newline.
  kCompact,   ///< Without any blank.
};

/// Writes JSON objects and arrays in the order of the calls. Keys are empty in arrays.
class JsonWriter {
 public:
  explicit JsonWriter(JsonLayout layout = JsonLayout::kIndented) : layout_(layout) {}

  void begin(char bracket);
  void begin(std::string_view key, char bracket) {
    separate(key);
    begin(bracket);
  }
  void end(char bracket);
  void text(std::string_view key, std::string_view value) { raw(key, jsonString(value)); }
  void truth(std::string_view key, bool value) { raw(key, value ? "true" : "false"); }
  void number(std::string_view key, std::integral auto value) {
    raw(key, fmt::format("{}", value));
  }
  /// The shortest text that reads back to the same number; null where it is not finite.
  void number(std::string_view key, std::floating_point auto value) {
    raw(key, std::isfinite(value) ? fmt::format("{}", value) : "null");
  }
  /// An array of numbers in one line.
  template <class T>
  void numbers(std::string_view key, std::span<const T> values) {
    std::string line = "[";
    for (const T value : values) {
      if (line.size() > 1) line += ',';
      line += std::isfinite(static_cast<double>(value)) ? fmt::format("{}", value) : "null";
    }
    raw(key, line + ']');
  }
  /// What is JSON already.
  void raw(std::string_view key, std::string_view value) {
    separate(key);
    text_ += value;
  }
  [[nodiscard]] std::string take();

 private:
  void newLine();
  void separate(std::string_view key);

  JsonLayout layout_;
  std::string text_;
  bool is_first_ = true;
  std::size_t depth_ = 0;
};

}  // namespace galactic
