#include "terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "support/console/standard_streams.h"
#include "support/console/terminal_line.h"
#include "support/text/printable.h"
#include "support/text/sentence_kinds.h"

namespace galactic::bake {
namespace {

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

std::string placeOf(const Error& error) {
  return isOption(error.where) ? "--" + error.where : withFlags(error.where);
}

void printError(const Error& error) {
  printToStderr(fmt::format("galactic-bake: {}: {}\n", printable(placeOf(error)),
                            printable(withFlags(error.message))));
}

int refuse(const Error& error) {
  printError(error);
  return static_cast<int>(error.code);
}

void printFailures(const PackOutcome& pack) {
  for (const BakeFailure& failure : pack.failures) printError(failure.error);
}

std::vector<std::string> warningLines(const std::vector<std::string>& warnings,
                                      Verbosity verbosity) {
  if (verbosity == Verbosity::kVerbose) return warnings;
  return oneOfEachKind(warnings, "-v lists them");
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
  const std::string line = fmt::format("[{}] {}: {}", bar, item, stage);
  printToStderr("\r\033[K" + fittingLine(line, STDERR_FILENO));
  shown_ = true;
}

void ProgressLine::clear() {
  if (!shown_) return;
  printToStderr("\r\033[K");
  shown_ = false;
}

}  // namespace galactic::bake
