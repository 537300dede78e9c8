#include "terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "support/printable.h"

namespace galactic::bake {
namespace {

/// So many warnings of one kind are all shown.
constexpr std::size_t kFew = 3;

/// A warning without names in quotes and numbers. An apostrophe inside a word quotes nothing.
std::string kindOf(std::string_view warning) {
  std::string kind;
  const auto is_word = [&](std::size_t at) {
    const char c = at < warning.size() ? warning[at] : ' ';
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  for (std::size_t at = 0; at < warning.size(); ++at) {
    const char c = warning[at];
    if (c >= '0' && c <= '9') continue;
    kind += c;
    if (c != '\'' || (at > 0 && is_word(at - 1))) continue;
    const std::size_t end = warning.find('\'', at + 1);
    if (end == std::string_view::npos) continue;
    kind += '\'';
    at = end;
  }
  return kind;
}

bool isOption(std::string_view name) {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = optionNames();
    all.insert(all.end(), {"scenes", "missing", "list"});
    return all;
  }();
  return std::ranges::find(names, name) != names.end() || isOfCommandLine(name);
}

}  // namespace

std::string withFlags(std::string_view message) {
  std::string text;
  while (true) {
    const std::size_t begin = message.find('`');
    const std::size_t end = begin == std::string_view::npos ? begin : message.find('`', begin + 1);
    text += message.substr(0, end == std::string_view::npos ? end : begin);
    if (end == std::string_view::npos) return text;
    const std::string_view name = message.substr(begin + 1, end - begin - 1);
    text += isOption(name) ? "--" + std::string(name) : fmt::format("`{}`", name);
    message.remove_prefix(end + 1);
  }
}

std::vector<std::string> withFlags(std::vector<std::string> messages) {
  for (std::string& message : messages) message = withFlags(message);
  return messages;
}

void printError(const Error& error) {
  const std::string where = isOption(error.where) ? "--" + error.where : error.where;
  fmt::print(stderr, "galactic-bake: {}: {}\n", printable(where),
             printable(withFlags(error.message)));
}

int refuse(const Error& error) {
  printError(error);
  return static_cast<int>(error.code);
}

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
    fmt::print("  warning: {}\n", printable(withFlags(line)));
  }
}

ProgressLine::ProgressLine(bool wanted) : enabled_(wanted && ::isatty(STDERR_FILENO) == 1) {}

void ProgressLine::show(std::string_view item, std::string_view stage, double fraction) {
  if (!enabled_) return;
  constexpr int kWidth = 20;
  const int done = static_cast<int>(fraction * kWidth);
  const std::string bar = std::string(static_cast<std::size_t>(done), '=') +
                          std::string(static_cast<std::size_t>(kWidth - done), ' ');
  fmt::print(stderr, "\r\033[K[{}] {}: {}", bar, item, stage);
  std::fflush(stderr);
  shown_ = true;
}

void ProgressLine::clear() {
  if (!shown_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace galactic::bake
