#include "command_line/option_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace galactic {

std::string optionLines(const SimulationOptions& options) {
  std::string lines;
  for (const OptionText& option : listOptions(options)) {
    lines += option.name + "=" + option.value + "\n";
  }
  return lines;
}

Result<SimulationOptions> parseOptionLines(std::string_view lines, const std::string& where) {
  std::vector<OptionText> texts;
  while (!lines.empty()) {
    const std::size_t end = lines.find('\n');
    const std::string_view line = lines.substr(0, end);
    const std::size_t equals = line.find('=');
    const std::string_view name = line.substr(0, equals);
    const bool is_line = end != std::string_view::npos && equals != std::string_view::npos &&
                         std::none_of(texts.begin(), texts.end(),
                                      [name](const OptionText& one) { return one.name == name; });
    if (!is_line) {
      return fail(ErrorCode::kInvalidInput, where + ": options",
                  "found something else than lines name=value, each name once; the file is "
                  "damaged");
    }
    texts.push_back({std::string(name), std::string(line.substr(equals + 1))});
    lines.remove_prefix(end + 1);
  }
  SimulationOptions options;
  const auto fault = setOptions(texts, OptionScope::kAll, options);
  if (!fault) return options;
  const OptionText& text = texts[fault->index];
  if (fault->wanted.empty()) {
    return fail(ErrorCode::kUnsupported, where,
                "has the option " + text.name +
                    ", which this version does not know; use the version that wrote it");
  }
  return fail(ErrorCode::kInvalidInput, where + ": options",
              fmt::format("{} is \"{}\", expected {}; the file is damaged", text.name, text.value,
                          fault->wanted));
}

std::optional<OptionText> firstDifference(const SimulationOptions& a, const SimulationOptions& b) {
  const std::vector<OptionText> of_a = listOptions(a);
  const std::vector<OptionText> of_b = listOptions(b);
  for (std::size_t n = 0; n < of_a.size(); ++n) {
    if (of_a[n].value != of_b[n].value) return of_a[n];
  }
  return std::nullopt;
}

}  // namespace galactic
