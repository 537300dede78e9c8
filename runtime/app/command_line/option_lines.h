#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "galactic/error.h"
#include "galactic/option_text.h"
#include "galactic/simulation_options.h"

namespace galactic {

/// The options as lines of the form "name=value", for a recording.
[[nodiscard]] std::string optionLines(const SimulationOptions& options);

/// Reads options from such lines; options that they do not name keep their defaults. Fails with
/// kInvalidInput on an invalid value, and with kUnsupported on an unknown name. `where` names the
/// file.
[[nodiscard]] Result<SimulationOptions> parseOptionLines(std::string_view lines,
                                                         const std::string& where);

/// The first option in which `a` and `b` differ, with the value in `a`.
[[nodiscard]] std::optional<OptionText> firstDifference(const SimulationOptions& a,
                                                        const SimulationOptions& b);

}  // namespace galactic
