#pragma once
#include <pybind11/pybind11.h>

#include <vector>

#include "galactic/option_text.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"

namespace galactic::python {

namespace py = pybind11;

/// The options that keywords name: those of the option table with '_' for '-', and `threads`,
/// `body_transforms` and `auto_reset`. What they do not name is what the world says of its task,
/// else the default. A value of None counts as not given. Throws a Refusal for a wrong value and
/// TypeError, with the nearest name, for an unknown keyword.
[[nodiscard]] SimulationOptions optionsOf(const World& world, const py::dict& keywords);

/// The options of task, reward and robot (OptionScope::kTask) that keywords, named as above, give
/// another value than the default or name themselves, in the order of the table.
[[nodiscard]] std::vector<OptionText> taskTextsOf(const py::dict& keywords);

/// The same options as keywords with their values, those of the option table.
[[nodiscard]] py::dict keywordsOf(const SimulationOptions& options);

}  // namespace galactic::python
