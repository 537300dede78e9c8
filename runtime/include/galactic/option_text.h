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
  /// As galactic-run reads it; of a switch "true" or "false".
  std::string value;
  /// For JSON: whether the value is a word, not a number or truth value.
  bool is_word = false;

  friend bool operator==(const OptionText&, const OptionText&) = default;
};

/// Which options of the table.
enum class OptionScope {
  /// All that decide what a simulation does.
  kAll,
  /// What a world may say of its task (visitWorldTask): not those of a batch.
  kTask,
  /// Of kTask, those of RobotNoise: what robots do and know otherwise than asked and told.
  kRobotNoise,
  /// kAll, and the presets, which options named beside them refine: what a user may type.
  kTyped,
};

/// Why a list of texts cannot be read as options.
struct OptionFault {
  /// Of the offending text in the list.
  std::size_t index = 0;
  /// What its value should be, for example "0 to 1000"; empty if the table does not have its name,
  /// or an earlier text has the same name.
  std::string wanted;
};

/// The names of the options, in the order of the table.
[[nodiscard]] std::vector<std::string> optionNames(OptionScope scope);

/// Those of them that may be ranges from which each episode draws (DrawnNumber).
[[nodiscard]] std::vector<std::string> drawnOptionNames();

/// The options with their values, in the order of the table; numbers read back exactly. Presets are
/// not listed; the options that they set are.
[[nodiscard]] std::vector<OptionText> listOptions(const SimulationOptions& options,
                                                  OptionScope scope = OptionScope::kAll);

/// Gives `options` the values of `texts`, in any order; what they do not name keeps its value. On a
/// fault (the first in the order of the table, unknown names last), the values of `options` are
/// unspecified.
[[nodiscard]] std::optional<OptionFault> setOptions(std::span<const OptionText> texts,
                                                    OptionScope scope, SimulationOptions& options);

/// Whether every value lies in the range of the table and every enumeration has one of its values:
/// what BatchSimulator::create asks first. Fails with kInvalidInput; the message names the option,
/// its value and the range.
[[nodiscard]] Result<void> checkOptions(const SimulationOptions& options);

}  // namespace galactic
