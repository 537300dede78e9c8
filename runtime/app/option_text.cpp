#include "option_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "option_table.h"

namespace galactic {
namespace {

/// Collects names and values.
class Lister {
 public:
  explicit Lister(std::vector<OptionText>& list) : list_(list) {}

  void group(std::string_view) {}
  void whole(std::string_view name, std::uint32_t value, Within<std::uint32_t>, std::string_view) {
    add(name, fmt::format("{}", value), false);
  }
  void seed(std::string_view name, std::uint64_t value, std::string_view) {
    add(name, fmt::format("{}", value), false);
  }
  void real(std::string_view name, float value, Within<float>, std::string_view) {
    add(name, fmt::format("{}", value), false);
  }
  void flag(std::string_view name, const Switch& value, std::string_view) {
    add(name, value.field == value.when_typed ? "true" : "false", false);
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T value, const std::array<Named<T>, N>& names,
              std::string_view) {
    const auto found = std::find_if(names.begin(), names.end(),
                                    [&](const Named<T>& one) { return one.value == value; });
    add(name, found == names.end() ? "" : std::string(found->name), true);
  }

 private:
  void add(std::string_view name, std::string value, bool is_word) {
    list_.push_back({std::string(name), std::move(value), is_word});
  }

  std::vector<OptionText>& list_;
};

/// Gives the options the values that were read.
class Setter {
 public:
  Setter(std::map<std::string, std::string, std::less<>> values, const std::string& where)
      : values_(std::move(values)), where_(where) {}

  void group(std::string_view) {}
  void whole(std::string_view name, std::uint32_t& field, Within<std::uint32_t> within,
             std::string_view) {
    number(name, field, within);
  }
  void seed(std::string_view name, std::uint64_t& field, std::string_view) {
    number(name, field, Within<std::uint64_t>{0, UINT64_MAX});
  }
  void real(std::string_view name, float& field, Within<float> within, std::string_view) {
    number(name, field, within);
  }
  void flag(std::string_view name, const Switch& value, std::string_view) {
    const std::optional<std::string> text = take(name);
    if (!text) return;
    require(*text == "true" || *text == "false", name, *text, "true or false");
    value.field = (*text == "true") == value.when_typed;
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T& field, const std::array<Named<T>, N>& names,
              std::string_view) {
    const std::optional<std::string> text = take(name);
    if (!text) return;
    const auto found = std::find_if(names.begin(), names.end(),
                                    [&](const Named<T>& one) { return one.name == *text; });
    require(found != names.end(), name, *text, "one of its names");
    if (found != names.end()) field = found->value;
  }

  [[nodiscard]] Result<void> result() const {
    if (error_) return tl::unexpected<Error>(*error_);
    if (values_.empty()) return {};
    return fail(ErrorCode::kUnsupported, where_,
                "has the option " + values_.begin()->first +
                    ", which this version does not know; use the version that wrote it");
  }

 private:
  std::optional<std::string> take(std::string_view name) {
    const auto found = values_.find(name);
    if (found == values_.end()) return std::nullopt;
    std::string value = std::move(found->second);
    values_.erase(found);
    return value;
  }

  template <class T>
  void number(std::string_view name, T& field, Within<T> within) {
    const std::optional<std::string> text = take(name);
    if (!text) return;
    T value{};
    const char* end = text->data() + text->size();
    const auto [stop, problem] = std::from_chars(text->data(), end, value);
    const bool is_good =
        problem == std::errc() && stop == end && value >= within.least && value <= within.most;
    require(is_good, name, *text, fmt::format("{} to {}", within.least, within.most));
    if (is_good) field = value;
  }

  void require(bool is_good, std::string_view name, std::string_view found,
               std::string_view wanted) {
    if (is_good || error_) return;
    error_ =
        Error{ErrorCode::kInvalidInput, where_ + ": options",
              fmt::format("{} is \"{}\", wanted {}; the file is damaged", name, found, wanted)};
  }

  std::map<std::string, std::string, std::less<>> values_;
  const std::string& where_;
  std::optional<Error> error_;
};

}  // namespace

std::vector<OptionText> listOptions(const SimulationOptions& options) {
  std::vector<OptionText> list;
  SimulationOptions copy = options;
  Lister lister(list);
  visitOptions(copy, lister);
  return list;
}

std::string optionLines(const SimulationOptions& options) {
  std::string lines;
  for (const OptionText& option : listOptions(options)) {
    lines += option.name + "=" + option.value + "\n";
  }
  return lines;
}

Result<SimulationOptions> parseOptionLines(std::string_view lines, const std::string& where) {
  std::map<std::string, std::string, std::less<>> values;
  while (!lines.empty()) {
    const std::size_t end = lines.find('\n');
    const std::string_view line = lines.substr(0, end);
    const std::size_t equals = line.find('=');
    const bool is_line = end != std::string_view::npos && equals != std::string_view::npos;
    if (!is_line || !values.emplace(line.substr(0, equals), line.substr(equals + 1)).second) {
      return fail(ErrorCode::kInvalidInput, where + ": options",
                  "found something else than lines name=value, each name once; the file is "
                  "damaged");
    }
    lines.remove_prefix(end + 1);
  }
  SimulationOptions options;
  Setter setter(std::move(values), where);
  visitOptions(options, setter);
  if (Result<void> set = setter.result(); !set) return tl::unexpected<Error>(set.error());
  return options;
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
