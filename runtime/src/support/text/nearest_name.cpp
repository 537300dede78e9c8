#include "support/text/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <utility>

namespace galactic {
namespace {

constexpr std::size_t kMostSuggested = 3;
constexpr std::size_t kMostListed = 12;
/// Only this many letters are compared, because names may be hostile.
constexpr std::size_t kLongestCompared = 200;

/// Number of letters to insert, remove or replace, ignoring case (Levenshtein).
std::size_t editDistance(std::string_view a, std::string_view b) {
  a = a.substr(0, kLongestCompared);
  b = b.substr(0, kLongestCompared);
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row.back();
}

/// "a,b,c" as "a, b or c".
std::string asSentence(std::string_view list) {
  std::string sentence;
  while (true) {
    const std::size_t comma = list.find(',');
    sentence += list.substr(0, comma);
    if (comma == list.npos) return sentence;
    list.remove_prefix(comma + 1);
    sentence += list.find(',') == list.npos ? " or " : ", ";
  }
}

/// Rewords a complaint of CLI11 about the value of an option, "OPTION: ..."; returns any other as
/// it is.
std::string inOurWords(std::string_view complaint) {
  constexpr std::string_view kSeveral = "At Most 1 required but received ";
  constexpr std::string_view kMissing = "1 required ";
  constexpr std::string_view kNotIn = " not in {";
  const std::size_t colon = complaint.find(": ");
  if (colon == complaint.npos) return std::string(complaint);
  const std::string_view option = complaint.substr(0, colon);
  const std::string_view rest = complaint.substr(colon + 2);
  if (rest.starts_with(kSeveral)) {
    return fmt::format("{}: is given {} times; give it once", option, rest.substr(kSeveral.size()));
  }
  if (rest.starts_with(kMissing) && rest.ends_with(" missing")) {
    return fmt::format("{}: found no value, expected one", option);
  }
  const std::size_t list = rest.rfind(kNotIn);
  if (list != rest.npos && rest.ends_with('}')) {
    const std::string_view names = rest.substr(list + kNotIn.size());
    return fmt::format("{}: found {}, expected {}", option, rest.substr(0, list),
                       asSentence(names.substr(0, names.size() - 1)));
  }
  return std::string(complaint);
}

}  // namespace

std::string suggestNames(std::string_view name, const std::vector<std::string>& known) {
  std::vector<std::pair<std::size_t, std::string_view>> near;
  const std::size_t reach = std::max<std::size_t>(2, name.size() / 3);
  for (const std::string& candidate : known) {
    const std::size_t distance = editDistance(name, candidate);
    if (distance <= reach) near.emplace_back(distance, candidate);
  }
  std::stable_sort(near.begin(), near.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (near.size() > kMostSuggested) near.resize(kMostSuggested);
  if (!near.empty()) {
    std::string names;
    for (std::size_t i = 0; i < near.size(); ++i) {
      names += fmt::format("{}'{}'", i == 0 ? "" : " or ", near[i].second);
    }
    return fmt::format("did you mean {}?", names);
  }
  std::string names;
  for (std::size_t i = 0; i < std::min(known.size(), kMostListed); ++i) {
    names += fmt::format("{}'{}'", i == 0 ? "" : ", ", known[i]);
  }
  if (known.size() > kMostListed) names += fmt::format(" and {} more", known.size() - kMostListed);
  return known.empty() ? "there are none" : "known are " + names;
}

std::string withSuggestions(std::string_view complaint, const std::vector<std::string>& known) {
  constexpr std::string_view kDashes = "--";
  const std::size_t begin = complaint.find(kDashes);
  if (begin == complaint.npos) return inOurWords(complaint);
  const std::size_t end = complaint.find_first_of(" =:,;", begin);
  const std::string_view option = complaint.substr(begin, end - begin);
  // If the option is known, the complaint is about something else.
  const bool is_known = std::find(known.begin(), known.end(), option) != known.end();
  if (option.size() == kDashes.size() || is_known) return inOurWords(complaint);
  const std::string suggestion = suggestNames(option, known);
  if (!suggestion.starts_with("did you mean")) return std::string(complaint);
  return fmt::format("{}; {}", complaint, suggestion);
}

}  // namespace galactic
