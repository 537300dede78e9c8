#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "galactic/bake/robot_recipe.h"
#include "support/text/nearest_name.h"
#include "toml/toml_table.h"

namespace galactic::bake {

/// The allowed range of a number.
struct NumberRange {
  double min = -std::numeric_limits<double>::max();
  double max = std::numeric_limits<double>::max();
  std::string_view unit;
};

/// Keeps the first error of a recipe and ignores later ones.
class FirstError {
 public:
  explicit FirstError(std::string file) : file_(std::move(file)) {}

  void at(std::uint32_t line, std::string message) {
    if (error_) return;
    error_ = Error{ErrorCode::kInvalidInput, place(line), std::move(message)};
  }
  void take(const Error& error) {
    if (!error_) error_ = error;
  }
  [[nodiscard]] std::string place(std::uint32_t line) const {
    return line == 0 ? file_ : fmt::format("{}:{}", file_, line);
  }
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  std::string file_;
  std::optional<Error> error_;
};

/// One table of a recipe, queried key by key. finish() reports keys that were never queried.
/// Missing or wrong values are reported to the FirstError, and a default is returned.
class RecipeTable {
 public:
  RecipeTable(const TomlTable& table, std::string name, std::uint32_t line, FirstError& errors)
      : table_(table), name_(std::move(name)), line_(line), errors_(errors) {}

  /// The value of a key, or null.
  const TomlValue* find(std::string_view key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
    return lookUp(key);
  }

  std::optional<double> number(std::string_view key, const NumberRange& range) {
    const TomlValue* value = find(key);
    if (value == nullptr) return std::nullopt;
    return numberOf(*value, key, range);
  }

  double requiredNumber(std::string_view key, const NumberRange& range) {
    const TomlValue* value = require(key);
    return value == nullptr ? 0 : numberOf(*value, key, range).value_or(0);
  }

  std::optional<std::uint32_t> count(std::string_view key, const NumberRange& range) {
    const TomlValue* value = find(key);
    if (value == nullptr) return std::nullopt;
    if (!std::holds_alternative<std::int64_t>(value->value)) {
      errors_.at(value->line, fmt::format("{}: expected a whole number", full(key)));
      return std::nullopt;
    }
    const auto checked = numberOf(*value, key, range);
    if (!checked) return std::nullopt;
    return static_cast<std::uint32_t>(*checked);
  }

  bool flag(std::string_view key) {
    const TomlValue* value = find(key);
    if (value == nullptr) return false;
    if (const bool* truth = std::get_if<bool>(&value->value)) return *truth;
    errors_.at(value->line, fmt::format("{}: expected true or false", full(key)));
    return false;
  }

  RecipeName requiredName(std::string_view key) {
    const TomlValue* value = require(key);
    return value == nullptr ? RecipeName{} : nameOf(*value, full(key));
  }

  /// kCount numbers, or none if the key is absent.
  template <std::size_t kCount>
  std::optional<std::array<double, kCount>> numbers(std::string_view key,
                                                    const NumberRange& range) {
    const TomlValue* value = find(key);
    if (value == nullptr) return std::nullopt;
    return numbersOf<kCount>(*value, full(key), range);
  }

  template <std::size_t kCount>
  std::array<double, kCount> numbersOf(const TomlValue& value, const std::string& what,
                                       const NumberRange& range) {
    std::array<double, kCount> numbers{};
    const auto* array = std::get_if<TomlArray>(&value.value);
    if (array == nullptr || array->size() != kCount) {
      errors_.at(value.line, fmt::format("{}: expected a list of {} numbers", what, kCount));
      return numbers;
    }
    for (std::size_t i = 0; i < kCount; ++i) {
      numbers[i] = checkedNumber((*array)[i], fmt::format("{}[{}]", what, i), range).value_or(0);
    }
    return numbers;
  }

  /// The table of a key; null if it is absent.
  const TomlTable* table(std::string_view key) {
    const TomlValue* value = find(key);
    if (value == nullptr) return nullptr;
    if (const auto* inner = std::get_if<TomlTable>(&value->value)) return inner;
    errors_.at(value->line, fmt::format("{}: expected a table, [{}]", full(key), full(key)));
    return nullptr;
  }

  const TomlTable* requiredTable(std::string_view key) {
    if (lookUp(key) == nullptr) {
      missing_.push_back(fmt::format("the table [{}] is missing", full(key)));
    }
    return table(key);
  }

  /// The list of a key; null if it is absent.
  const TomlArray* list(std::string_view key) {
    const TomlValue* value = find(key);
    if (value == nullptr) return nullptr;
    if (const auto* array = std::get_if<TomlArray>(&value->value)) return array;
    errors_.at(value->line, fmt::format("{}: expected a list", full(key)));
    return nullptr;
  }

  RecipeName nameOf(const TomlValue& value, const std::string& what) {
    const auto* text = std::get_if<std::string>(&value.value);
    if (text == nullptr || text->empty()) {
      errors_.at(value.line, fmt::format("{}: expected a name in quotes", what));
      return {};
    }
    return {*text, errors_.place(value.line)};
  }

  std::optional<double> numberOf(const TomlValue& value, std::string_view key,
                                 const NumberRange& range) {
    return checkedNumber(value, full(key), range);
  }

  /// Reports unknown keys before missing ones, because a misspelled key is both.
  void finish() {
    for (const auto& [key, value] : table_) {
      if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
      errors_.at(value.line,
                 fmt::format("the key {} is unknown; {}", full(key), suggestNames(key, known_)));
    }
    for (const std::string& message : missing_) errors_.at(line_, message);
  }

  [[nodiscard]] std::string full(std::string_view key) const {
    return name_.empty() ? std::string(key) : fmt::format("{}.{}", name_, key);
  }
  /// Such as "base" or "joints[2]"; empty for the outermost table.
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint32_t line() const { return line_; }
  [[nodiscard]] FirstError& errors() { return errors_; }

 private:
  [[nodiscard]] const TomlValue* lookUp(std::string_view key) const {
    for (const auto& [name, value] : table_) {
      if (name == key) return &value;
    }
    return nullptr;
  }

  const TomlValue* require(std::string_view key) {
    const TomlValue* value = find(key);
    if (value != nullptr) return value;
    missing_.push_back(fmt::format("the key {} is missing", full(key)));
    return nullptr;
  }

  std::optional<double> checkedNumber(const TomlValue& value, const std::string& what,
                                      const NumberRange& range) {
    double number = 0;
    if (const auto* real = std::get_if<double>(&value.value)) {
      number = *real;
    } else if (const auto* integer = std::get_if<std::int64_t>(&value.value)) {
      number = static_cast<double>(*integer);
    } else {
      errors_.at(value.line, fmt::format("{}: expected a number", what));
      return std::nullopt;
    }
    const bool within = number >= range.min && number <= range.max;  // false for NaN
    if (within) return number;
    if (!std::isfinite(number)) {
      errors_.at(value.line, fmt::format("{}: found {}, expected a finite number", what, number));
    } else {
      errors_.at(value.line,
                 fmt::format("{}: found {}, expected {} to {}{}{}", what, number, range.min,
                             range.max, range.unit.empty() ? "" : " ", range.unit));
    }
    return std::nullopt;
  }

  const TomlTable& table_;
  std::string name_;
  std::uint32_t line_;
  FirstError& errors_;
  std::vector<std::string> known_;
  std::vector<std::string> missing_;
};

}  // namespace galactic::bake
