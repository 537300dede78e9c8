#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace galactic::pack_tool {

/// Lines of text in columns that line up: the first column to the left, the others to the right.
class TextTable {
 public:
  /// Spaces before every line.
  explicit TextTable(int indent) : indent_(indent) {}

  /// Adds a line; lines may differ in length.
  void add(std::vector<std::string> cells) { lines_.push_back(std::move(cells)); }

  /// All lines, each closed by a newline.
  [[nodiscard]] std::string text() const;

 private:
  int indent_;
  std::vector<std::vector<std::string>> lines_;
};

/// A line "label  value" whose values line up when all labels are short.
[[nodiscard]] std::string labeled(std::string_view label, std::string_view value);

/// A whole number with commas between thousands.
[[nodiscard]] std::string grouped(std::uint64_t number);

}  // namespace galactic::pack_tool
