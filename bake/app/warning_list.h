#pragma once
#include <string>
#include <vector>

#include "options.h"

namespace galactic::bake {

/// One line for each warning, or for many of a kind (the same sentence but for names in quotes and
/// numbers) the first of them and how many more there are; all of them where `verbosity` is
/// kVerbose. In the order of the first of each kind.
[[nodiscard]] std::vector<std::string> warningLines(const std::vector<std::string>& warnings,
                                                    Verbosity verbosity);

/// Prints these lines to stdout.
void printWarnings(const std::vector<std::string>& warnings, Verbosity verbosity);

}  // namespace galactic::bake
