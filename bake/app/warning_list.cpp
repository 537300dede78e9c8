#include "warning_list.h"

#include <fmt/format.h>

#include <map>
#include <string_view>

#include "galactic/printable.h"

namespace galactic::bake {
namespace {

/// So many warnings of one kind are all shown.
constexpr std::size_t kFew = 3;

/// A warning without names in quotes and numbers. An apostrophe inside a word quotes nothing.
std::string kindOf(std::string_view warning) {
  std::string kind;
  const auto isWord = [&](std::size_t at) {
    const char c = at < warning.size() ? warning[at] : ' ';
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  for (std::size_t at = 0; at < warning.size(); ++at) {
    const char c = warning[at];
    if (c >= '0' && c <= '9') continue;
    kind += c;
    if (c != '\'' || (at > 0 && isWord(at - 1))) continue;
    const std::size_t end = warning.find('\'', at + 1);
    if (end == std::string_view::npos) continue;
    kind += '\'';
    at = end;
  }
  return kind;
}

}  // namespace

std::vector<std::string> warningLines(const std::vector<std::string>& warnings,
                                      Verbosity verbosity) {
  if (verbosity == Verbosity::kVerbose) return warnings;
  std::vector<std::vector<std::string>> kinds;
  std::map<std::string, std::size_t> place_of_kind;
  for (const std::string& warning : warnings) {
    const auto [place, is_new] = place_of_kind.try_emplace(kindOf(warning), kinds.size());
    if (is_new) kinds.emplace_back();
    kinds[place->second].push_back(warning);
  }
  std::vector<std::string> lines;
  for (const std::vector<std::string>& kind : kinds) {
    if (kind.size() <= kFew) {
      lines.insert(lines.end(), kind.begin(), kind.end());
    } else {
      lines.push_back(fmt::format("{} (and {} more of this kind; -v lists them)", kind.front(),
                                  kind.size() - 1));
    }
  }
  return lines;
}

void printWarnings(const std::vector<std::string>& warnings, Verbosity verbosity) {
  for (const std::string& line : warningLines(warnings, verbosity)) {
    fmt::print("  warning: {}\n", printable(line));
  }
}

}  // namespace galactic::bake
