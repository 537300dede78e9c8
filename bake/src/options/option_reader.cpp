#include "galactic/bake/option_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "support/nearest_name.h"

namespace galactic::bake {
namespace {

/// A text, number or truth value; none where it is something else.
std::optional<GivenWord> wordOf(const TomlValue& value) {
  if (const auto* truth = std::get_if<bool>(&value.value)) return *truth;
  if (const auto* whole = std::get_if<std::int64_t>(&value.value)) return *whole;
  if (const auto* real = std::get_if<double>(&value.value)) return *real;
  if (const auto* text = std::get_if<std::string>(&value.value)) return *text;
  return std::nullopt;
}

/// The words of a list without lists in it.
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

bool isEmpty(const GivenValue& value) {
  return value.words.empty() ||
         std::any_of(value.words.begin(), value.words.end(), [](const GivenWord& word) {
           const auto* text = std::get_if<std::string>(&word);
           return text != nullptr && text->empty();
         });
}

/// What is wrong whatever the option is; empty: nothing.
std::string faultOf(const GivenOption& given, const OptionField& field) {
  if (std::any_of(given.values.begin(), given.values.end(), isEmpty)) {
    return "has an empty value; give one, or leave the option out";
  }
  if (given.values.size() > 1 && !field.repeats()) return "is given twice; give it once";
  const bool takes_names =
      field.kind() == OptionKind::kNamedText || field.kind() == OptionKind::kNamedPath;
  const auto has_name = [](const GivenValue& value) { return !value.name.empty(); };
  if (takes_names || std::none_of(given.values.begin(), given.values.end(), has_name)) return {};
  return "is a table, a value or a list of values is wanted";
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
                  "is a table or a list of lists, a value or a list of values is wanted");
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

const GivenOption* OptionReader::find(std::string_view name) const {
  const GivenOption* last = nullptr;
  for (const GivenOption& one : given_) {
    if (one.name == name) last = &one;
  }
  return last;
}

bool OptionReader::isGiven(std::string_view name) const { return find(name) != nullptr; }

Result<void> OptionReader::refuse(std::string_view name, std::string message) const {
  const GivenOption* given = find(name);
  if (given == nullptr) return {};
  return fail(ErrorCode::kInvalidInput, given->place, std::move(message));
}

void OptionReader::option(const OptionInfo& info, OptionField& field) {
  const GivenOption* given = find(info.name);
  if (given == nullptr || !taken_.emplace(info.name).second || error_) return;
  std::string fault = faultOf(*given, field);
  if (fault.empty()) fault = field.read(given->values);
  if (!fault.empty()) {
    error_ = Error{ErrorCode::kInvalidInput, given->place, std::move(fault)};
    return;
  }
  if (!find_) return;
  for (std::filesystem::path* path : field.paths()) {
    auto found = find_(*path);
    if (!found) {
      error_ = Error{found.error().code, given->place,
                     found.error().where + " " + found.error().message};
      return;
    }
    *path = std::move(*found);
  }
}

Result<void> OptionReader::finish(std::string_view what,
                                  const std::vector<std::string>& known) const {
  if (error_) return tl::unexpected(*error_);
  for (const GivenOption& one : given_) {
    if (taken_.contains(one.name)) continue;
    if (std::ranges::find(known, one.name) == known.end()) {
      return fail(ErrorCode::kInvalidInput, one.place,
                  "is no option; " + suggestNames(one.name, known));
    }
    return fail(ErrorCode::kInvalidInput, one.place,
                fmt::format("does not go with {}; leave it out", what));
  }
  return {};
}

}  // namespace galactic::bake
