#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "command.h"
#include "galactic/error.h"

namespace galactic::bake {

/// A message of the library, whose `option` in backquotes becomes --option; other words in
/// backquotes stay as they are.
[[nodiscard]] std::string withFlags(std::string_view message);
[[nodiscard]] std::vector<std::string> withFlags(std::vector<std::string> messages);

/// Where an error is: the file and in it the option that the library names, or an option alone,
/// with flags.
[[nodiscard]] std::string placeOf(const Error& error);

/// One line on stderr: program, place, message, with flags.
void printError(const Error& error);

/// The same; the exit code.
[[nodiscard]] int refuse(const Error& error);

/// The same of all that failed in a pack.
void printFailures(const PackOutcome& pack);

/// One line for each warning, or for many of a kind (the same sentence but for names in quotes and
/// numbers) the first of them and how many more there are; all of them where `verbosity` is
/// kVerbose. In the order of the first of each kind.
[[nodiscard]] std::vector<std::string> warningLines(const std::vector<std::string>& warnings,
                                                    Verbosity verbosity);

/// Prints these lines to stdout.
void printWarnings(const std::vector<std::string>& warnings, Verbosity verbosity);

/// One line on a terminal that says what is being done; silent elsewhere.
class ProgressLine {
 public:
  /// `wanted` is what the user asked for; a line appears only if stderr is also a terminal.
  explicit ProgressLine(bool wanted);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  [[nodiscard]] bool isEnabled() const { return enabled_; }

  /// Replaces the line. `fraction` from 0 to 1.
  void show(std::string_view item, std::string_view stage, double fraction);
  /// Removes the line, so that other output begins on a clean one.
  void clear();

 private:
  bool enabled_;
  bool shown_ = false;
};

}  // namespace galactic::bake
