#include "toml/given_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "support/try.h"

namespace galactic::bake {
namespace {

/// A text, number or truth value as a word; none for other values.
std::optional<GivenWord> wordOf(const TomlValue& value) {
  if (const auto* truth = std::get_if<bool>(&value.value)) return *truth;
  if (const auto* whole = std::get_if<std::int64_t>(&value.value)) return *whole;
  if (const auto* real = std::get_if<double>(&value.value)) return *real;
  if (const auto* text = std::get_if<std::string>(&value.value)) return *text;
  return std::nullopt;
}

/// The words of a list; none if it contains lists or tables.
std::optional<std::vector<GivenWord>> wordsOf(const TomlArray& list) {
  std::vector<GivenWord> words;
  for (const TomlValue& value : list) {
    auto word = wordOf(value);
    if (!word) return std::nullopt;
    words.push_back(std::move(*word));
  }
  return words;
}

std::optional<std::vector<GivenValue>> valuesOf(const TomlArray& list) {
  const auto words = wordsOf(list);
  const auto is_text = [](const GivenWord& word) {
    return std::holds_alternative<std::string>(word);
  };
  if (words && std::none_of(words->begin(), words->end(), is_text)) {
    return std::vector<GivenValue>{{.name = {}, .words = *words}};
  }
  std::vector<GivenValue> values;
  for (const TomlValue& value : list) {
    const auto* inner = std::get_if<TomlArray>(&value.value);
    auto inside = inner != nullptr ? wordsOf(*inner) : std::nullopt;
    if (auto word = wordOf(value)) inside = std::vector<GivenWord>{std::move(*word)};
    if (!inside || inside->empty()) return std::nullopt;
    values.push_back({.name = {}, .words = std::move(*inside)});
  }
  return values;
}

std::optional<std::vector<GivenValue>> valuesOf(const TomlTable& table) {
  std::vector<GivenValue> values;
  for (const TomlEntry& entry : table) {
    auto word = wordOf(entry.value);
    if (!word) return std::nullopt;
    values.push_back({.name = entry.key, .words = {std::move(*word)}});
  }
  return values;
}

std::optional<std::vector<GivenValue>> valuesOf(const TomlValue& value) {
  if (const auto* list = std::get_if<TomlArray>(&value.value)) return valuesOf(*list);
  if (const auto* table = std::get_if<TomlTable>(&value.value)) return valuesOf(*table);
  return std::vector<GivenValue>{{.name = {}, .words = {*wordOf(value)}}};
}

}  // namespace

Result<std::vector<GivenOption>> givenIn(const TomlTable& table, const std::string& file,
                                         const std::function<bool(std::string_view)>& passes) {
  std::vector<GivenOption> given;
  for (const TomlEntry& entry : table) {
    if (passes && passes(entry.key)) continue;
    GivenOption one{.name = entry.key,
                    .values = {},
                    .place = fmt::format("{}:{}: {}", file, entry.value.line, entry.key)};
    auto values = valuesOf(entry.value);
    if (!values) {
      return fail(ErrorCode::kInvalidInput, one.place,
                  "is a table or a list of lists, expected a value or a list of values");
    }
    if (values->empty()) {
      return fail(ErrorCode::kInvalidInput, one.place,
                  "has an empty value; give one, or leave the option out");
    }
    one.values = std::move(*values);
    given.push_back(std::move(one));
  }
  return given;
}

Result<std::vector<GivenOption>> readOptionFile(const std::filesystem::path& file) {
  ASSIGN_OR_RETURN(const auto table, readToml(file));
  return givenIn(table, file.string());
}

}  // namespace galactic::bake
