#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "galactic/simulation_options.h"

namespace galactic {

/// An option of the table in option_table.h, as text.
struct OptionText {
  /// Long name without dashes, for example "episode-steps".
  std::string name;
  /// The value as galactic-run reads it; "true" or "false" for a switch.
  std::string value;
  /// For JSON: whether the value is a word, and not a number or a truth value.
  bool is_word = false;

  friend bool operator==(const OptionText&, const OptionText&) = default;
};

/// Which options of the table.
enum class OptionScope {
  /// All options that decide what a simulation does.
  kAll,
  /// The options of its task that a world may set (visitWorldTask): not those of a batch.
  kTask,
  /// The options of RobotNoise, which are a part of kTask.
  kRobotNoise,
  /// What a user may type: kAll, and the presets, which other options given with them refine.
  kTyped,
};

/// Why a list of texts cannot be read as options.
struct OptionFault {
  /// Index of the offending text in the list.
  std::size_t index = 0;
  /// What its value should be, for example "0 to 1000"; empty if its name is not in the table, or
  /// if an earlier text has the same name.
  std::string wanted;
};

/// The names of the options, in the order of the table.
[[nodiscard]] std::vector<std::string> optionNames(OptionScope scope);

/// The names of the options that may be ranges from which each episode draws (DrawnNumber).
[[nodiscard]] std::vector<std::string> drawnOptionNames();

/// The options with their values, in the order of the table; numbers read back exactly. Presets are
/// not listed; the options that they set are.
[[nodiscard]] std::vector<OptionText> listOptions(const SimulationOptions& options,
                                                  OptionScope scope = OptionScope::kAll);

/// Sets `options` to the values of `texts`, which may be in any order; options that they do not
/// name keep their values. Returns the first fault in the order of the table, unknown names last;
/// the values of `options` are then unspecified.
[[nodiscard]] std::optional<OptionFault> setOptions(std::span<const OptionText> texts,
                                                    OptionScope scope, SimulationOptions& options);

/// Checks that every value lies in the table's range and every enumeration has one of its values.
/// BatchSimulator::create() does this first. Fails with kInvalidInput; the message names the
/// option, its value and the range.
[[nodiscard]] Result<void> checkOptions(const SimulationOptions& options);

}  // namespace galactic
