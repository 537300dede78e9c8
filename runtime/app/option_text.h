#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/error.h"
#include "galactic/simulation_options.h"

namespace galactic {

/// An option as text.
struct OptionText {
  std::string name;
  std::string value;
  /// For JSON: whether the value is a word, not a number or truth value.
  bool is_word = false;
};

/// Every option that decides what a simulation does, with its value; numbers read back exactly.
[[nodiscard]] std::vector<OptionText> listOptions(const SimulationOptions& options);

/// The options as lines "name=value", for a recording.
[[nodiscard]] std::string optionLines(const SimulationOptions& options);

/// The options of such lines; those that are not named keep their defaults. Fails with
/// kInvalidInput on a value that makes no sense, and with kUnsupported on an unknown name. `where`
/// names the file.
[[nodiscard]] Result<SimulationOptions> parseOptionLines(std::string_view lines,
                                                         const std::string& where);

/// The first option in which `a` and `b` differ, with the value in `a`.
[[nodiscard]] std::optional<OptionText> firstDifference(const SimulationOptions& a,
                                                        const SimulationOptions& b);

}  // namespace galactic
