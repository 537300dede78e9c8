#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "command.h"
#include "galactic/error.h"

namespace galactic::bake {

/// A message of the library with each `option` in backquotes turned into --option. Other words in
/// backquotes are left alone.
[[nodiscard]] std::string withFlags(std::string_view message);
[[nodiscard]] std::vector<std::string> withFlags(std::vector<std::string> messages);

/// Where an error is: the file and the option in it that the library names, or only an option.
/// Options are written as flags.
[[nodiscard]] std::string placeOf(const Error& error);

/// Prints one line to stderr: program, place and message, with options written as flags.
void printError(const Error& error);

/// Prints the error and returns its exit code.
[[nodiscard]] int refuse(const Error& error);

/// Prints all failures of a pack.
void printFailures(const PackOutcome& pack);

/// One line per warning. Of many that differ only in quoted names and numbers, just the first, with
/// the number of others, unless `verbosity` is kVerbose. Ordered by the first of each kind.
[[nodiscard]] std::vector<std::string> warningLines(const std::vector<std::string>& warnings,
                                                    Verbosity verbosity);

/// Prints the lines of warningLines() to stdout.
void printWarnings(const std::vector<std::string>& warnings, Verbosity verbosity);

/// A line on a terminal that shows the progress; prints nothing elsewhere.
class ProgressLine {
 public:
  /// `wanted`: whether the user wants the line. It appears only if stderr is a terminal, too.
  explicit ProgressLine(bool wanted);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  [[nodiscard]] bool isEnabled() const { return enabled_; }

  /// Replaces the line. `fraction` from 0 to 1.
  void show(std::string_view item, std::string_view stage, double fraction);
  /// Removes the line, so that other output starts on an empty one.
  void clear();

 private:
  bool enabled_;
  bool shown_ = false;
};

}  // namespace galactic::bake
