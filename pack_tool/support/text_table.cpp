#include "pack_tool/support/text_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace galactic::pack_tool {

std::string TextTable::text() const {
  std::vector<std::size_t> widths;
  for (const auto& line : lines_) {
    widths.resize(std::max(widths.size(), line.size()));
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  }
  std::string text;
  for (const auto& line : lines_) {
    std::string row(static_cast<std::size_t>(indent_), ' ');
    for (std::size_t c = 0; c < line.size(); ++c) {
      row += c == 0 ? fmt::format("{:<{}}", line[c], widths[c])
                    : fmt::format("  {:>{}}", line[c], widths[c]);
    }
    // A short line leaves no blanks at its end.
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + '\n';
  }
  return text;
}

std::string labeled(std::string_view label, std::string_view value) {
  return fmt::format("  {:<12} {}\n", label, value);
}

std::string grouped(std::uint64_t number) {
  std::string digits = std::to_string(number);
  for (auto place = static_cast<std::ptrdiff_t>(digits.size()) - 3; place > 0; place -= 3) {
    digits.insert(static_cast<std::size_t>(place), 1, ',');
  }
  return digits;
}

}  // namespace galactic::pack_tool
