#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "galactic/bake/option_field.h"
#include "support/text/nearest_name.h"

namespace galactic::bake {
namespace {

bool isEmpty(const GivenValue& value) {
  return value.words.empty() ||
         std::any_of(value.words.begin(), value.words.end(), [](const GivenWord& word) {
           const auto* text = std::get_if<std::string>(&word);
           return text != nullptr && text->empty();
         });
}

/// A fault that any option may have; empty if there is none.
std::string faultOf(const GivenOption& given, const OptionField& field) {
  if (std::any_of(given.values.begin(), given.values.end(), isEmpty)) {
    return "has an empty value; give one, or leave the option out";
  }
  if (given.values.size() > 1 && !field.repeats()) return "is given twice; give it once";
  const bool takes_names =
      field.kind() == OptionKind::kNamedText || field.kind() == OptionKind::kNamedPath;
  const auto has_name = [](const GivenValue& value) { return !value.name.empty(); };
  if (takes_names || std::none_of(given.values.begin(), given.values.end(), has_name)) return {};
  return "is a table, expected a value or a list of values";
}

}  // namespace

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
                  "is not an option; " + suggestNames(one.name, known));
    }
    return fail(ErrorCode::kInvalidInput, one.place,
                fmt::format("does not go with {}; leave it out", what));
  }
  return {};
}

}  // namespace galactic::bake
