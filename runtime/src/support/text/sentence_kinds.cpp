#include "support/text/sentence_kinds.h"

#include <fmt/format.h>

#include <cstddef>
#include <map>

namespace galactic {
namespace {

/// Up to this many sentences of one kind are all shown.
constexpr std::size_t kFew = 3;

/// A sentence without the names in quotes and the numbers. An apostrophe inside a word is no quote.
std::string kindOf(std::string_view sentence) {
  std::string kind;
  const auto is_word = [&](std::size_t at) {
    const char c = at < sentence.size() ? sentence[at] : ' ';
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  for (std::size_t at = 0; at < sentence.size(); ++at) {
    const char c = sentence[at];
    if (c >= '0' && c <= '9') continue;
    kind += c;
    if (c != '\'' || (at > 0 && is_word(at - 1))) continue;
    const std::size_t end = sentence.find('\'', at + 1);
    if (end == std::string_view::npos) continue;
    kind += '\'';
    at = end;
  }
  return kind;
}

}  // namespace

std::vector<std::string> oneOfEachKind(const std::vector<std::string>& sentences,
                                       std::string_view who_lists_them) {
  std::vector<std::vector<std::string>> kinds;
  std::map<std::string, std::size_t> place_of_kind;
  for (const std::string& sentence : sentences) {
    const auto [place, is_new] = place_of_kind.try_emplace(kindOf(sentence), kinds.size());
    if (is_new) kinds.emplace_back();
    kinds[place->second].push_back(sentence);
  }
  std::vector<std::string> lines;
  for (const std::vector<std::string>& kind : kinds) {
    if (kind.size() <= kFew) {
      lines.insert(lines.end(), kind.begin(), kind.end());
    } else {
      lines.push_back(fmt::format("{} (and {} more of this kind; {})", kind.front(),
                                  kind.size() - 1, who_lists_them));
    }
  }
  return lines;
}

}  // namespace galactic
