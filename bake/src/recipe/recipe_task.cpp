#include "recipe/recipe_task.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "support/option_table.h"
#include "support/text/height_text.h"
#include "support/text/range_text.h"

namespace galactic::bake {
namespace {

/// The text of a value, for messages that refuse it.
struct ValueName {
  std::string operator()(bool truth) const { return truth ? "true" : "false"; }
  std::string operator()(std::int64_t whole) const { return fmt::format("{}", whole); }
  std::string operator()(double real) const { return fmt::format("{}", real); }
  std::string operator()(const std::string& text) const { return fmt::format("\"{}\"", text); }
  std::string operator()(const TomlArray&) const { return "a list"; }
  std::string operator()(const TomlTable&) const { return "a table"; }
};

/// Sets the options of the option table to the values of a TOML table.
class TaskReader {
 public:
  TaskReader(const TomlTable& table, std::uint32_t line, FirstError& errors)
      : table_(table, "task", line, errors), errors_(errors) {}

  void group(std::string_view) {}
  void whole(std::string_view name, std::uint32_t& field, Within<std::uint32_t> within,
             std::string_view) {
    const TomlValue* value = take(name);
    if (value == nullptr) return;
    const auto* number = std::get_if<std::int64_t>(&value->value);
    if (number != nullptr && *number >= within.least && *number <= within.most) {
      field = static_cast<std::uint32_t>(*number);
    } else {
      refuse(name, *value, fmt::format("a whole number from {} to {}", within.least, within.most));
    }
  }
  void real(std::string_view name, float& field, Within<float> within, std::string_view) {
    const TomlValue* value = take(name);
    if (value == nullptr) return;
    const std::optional<double> number = numberOf(*value);
    // This comparison is false for NaN.
    if (number && *number >= static_cast<double>(within.least) &&
        *number <= static_cast<double>(within.most)) {
      field = static_cast<float>(*number);
    } else {
      refuse(name, *value, fmt::format("a number from {} to {}", within.least, within.most));
    }
  }
  /// Reads a number, or a range in quotes.
  void drawn(std::string_view name, DrawnNumber& field, const Span& within, std::string_view) {
    const TomlValue* value = take(name);
    if (value == nullptr) return;
    const auto* text = std::get_if<std::string>(&value->value);
    const std::optional<double> number = numberOf(*value);
    std::optional<DrawnNumber> read;
    if (text != nullptr) read = drawnFrom(*text, within);
    if (number) read = static_cast<float>(*number);
    if (read && isDrawnWithin(*read, within)) {
      field = *read;
    } else {
      refuse(name, *value, wantedDrawn(within));
    }
  }
  /// Reads a whole number, or a range in quotes.
  void drawn(std::string_view name, DrawnCount& field, std::uint32_t most, std::string_view) {
    const TomlValue* value = take(name);
    if (value == nullptr) return;
    const auto* text = std::get_if<std::string>(&value->value);
    const auto* number = std::get_if<std::int64_t>(&value->value);
    std::optional<DrawnCount> read;
    if (text != nullptr) read = drawnFrom(*text, most);
    if (number != nullptr && *number >= 0 && *number <= most) {
      read = static_cast<std::uint32_t>(*number);
    }
    if (read) {
      field = *read;
    } else {
      refuse(name, *value, wantedDrawn(most));
    }
  }
  void heights(std::string_view name, std::vector<Span>& field, const Span& within,
               std::string_view) {
    const TomlValue* value = take(name);
    if (value == nullptr) return;
    const auto* text = std::get_if<std::string>(&value->value);
    std::optional<std::vector<Span>> heights;
    if (text != nullptr) heights = heightsFrom(*text, within);
    if (heights) {
      field = std::move(*heights);
    } else {
      refuse(name, *value, wantedHeights(within));
    }
  }
  void flag(std::string_view name, const Switch& into, std::string_view) {
    const TomlValue* value = take(name);
    if (value == nullptr) return;
    if (const bool* is_on = std::get_if<bool>(&value->value)) {
      into.field = *is_on == into.when_typed;
    } else {
      refuse(name, *value, "true or false");
    }
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T& field, const std::array<Named<T>, N>& names,
              std::string_view) {
    if (const T* chosen = choose<T>(name, names)) field = *chosen;
  }
  template <class T>
  void preset(std::string_view name, T& field, const Preset<T>& preset, std::string_view) {
    const T* chosen = choose<T>(name, preset.names);
    if (chosen == nullptr) return;
    field = *chosen;
    given_.insert(preset.parts.begin(), preset.parts.end());
  }

  /// Reports names that the option table does not have.
  void finish() { table_.finish(); }
  [[nodiscard]] bool isGiven(std::string_view name) const { return given_.contains(name); }

 private:
  const TomlValue* take(std::string_view name) {
    const TomlValue* value = table_.find(name);
    if (value != nullptr) given_.insert(name);
    return value;
  }

  static std::optional<double> numberOf(const TomlValue& value) {
    if (const auto* real = std::get_if<double>(&value.value)) return *real;
    if (const auto* whole = std::get_if<std::int64_t>(&value.value)) {
      return static_cast<double>(*whole);
    }
    return std::nullopt;
  }

  /// The value whose name the table gives; null, and an error if the table gives another name,
  /// otherwise.
  template <class T>
  const T* choose(std::string_view name, std::span<const Named<T>> names) {
    const TomlValue* value = take(name);
    if (value == nullptr) return nullptr;
    const auto* word = std::get_if<std::string>(&value->value);
    const auto found = std::find_if(names.begin(), names.end(), [&](const Named<T>& one) {
      return word != nullptr && one.name == *word;
    });
    if (found != names.end()) return &found->value;
    refuse(name, *value, namesOf(names));
    return nullptr;
  }

  void refuse(std::string_view name, const TomlValue& value, std::string_view wanted) {
    errors_.at(value.line, fmt::format("{}: found {}, expected {}", table_.full(name),
                                       std::visit(ValueName{}, value.value), wanted));
  }

  RecipeTable table_;
  FirstError& errors_;
  /// Names of the options that were given; the strings of the option table outlive this.
  std::set<std::string_view> given_;
};

/// Refuses options that say how a batch runs rather than what its task is.
void refuseBatchOptions(const TomlTable& table, FirstError& errors) {
  const std::vector<OptionText> all = listOptions({});
  const std::vector<OptionText> of_task = listOptions({}, OptionScope::kTask);
  const auto has = [](std::span<const OptionText> options, std::string_view name) {
    return std::ranges::any_of(options, [&](const OptionText& one) { return one.name == name; });
  };
  for (const TomlEntry& entry : table) {
    if (!has(all, entry.key) || has(of_task, entry.key)) continue;
    errors.at(entry.value.line, fmt::format("task.{} says how a batch runs, not what its task is; "
                                            "give it to galactic-run",
                                            entry.key));
  }
}

}  // namespace

std::vector<OptionText> readRecipeTask(const TomlTable& table, std::uint32_t line,
                                       FirstError& errors) {
  refuseBatchOptions(table, errors);
  SimulationOptions options;
  TaskReader reader(table, line, errors);
  visitWorldTask(options, reader);
  reader.finish();
  std::vector<OptionText> given = listOptions(options, OptionScope::kTask);
  std::erase_if(given, [&](const OptionText& one) { return !reader.isGiven(one.name); });
  return given;
}

}  // namespace galactic::bake
