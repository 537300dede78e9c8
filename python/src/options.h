#pragma once
#include <pybind11/pybind11.h>

#include <cstdint>
#include <string>
#include <vector>

#include "galactic/drawn_number.h"
#include "galactic/option_text.h"
#include "galactic/pose.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"

namespace galactic::python {

namespace py = pybind11;

/// What a keyword is given, as a whole number of a range, a number, a truth value, or text. Throws
/// an ErrorException that says what was found; the last one says what was `wanted`, too.
[[nodiscard]] std::uint64_t wholeOf(const char* name, const py::handle& value, std::uint64_t least,
                                    std::uint64_t most);
[[nodiscard]] double numberOf(const char* name, const py::handle& value);
[[nodiscard]] bool truthOf(const char* name, const py::handle& value,
                           const char* wanted = "True or False");
[[nodiscard]] std::string wordOf(const char* name, const py::handle& value, const char* wanted);
/// The same of `threads`.
[[nodiscard]] std::uint32_t threadsOf(const py::handle& value);
/// The same of a number that episodes may draw: a number, a pair of them, or text.
[[nodiscard]] DrawnNumber drawnOf(const char* name, const py::handle& value, const Span& within);

/// What the keyword for an option of programs is called: as it is there, with '_' for '-'.
[[nodiscard]] std::string keywordOf(std::string option);

/// Whether it is a truth value, of Python or of numpy: those pass for whole numbers.
[[nodiscard]] bool isTruth(const py::handle& value);

/// The options that keywords name: those of the option table with '_' for '-', and `threads`,
/// `body_transforms` and `auto_reset`. What they do not name is what the world says of its task,
/// else the default. A value of None counts as not given. Throws an ErrorException for a wrong
/// value and TypeError, with the nearest name, for an unknown keyword.
[[nodiscard]] SimulationOptions optionsOf(const World& world, const py::dict& keywords);

/// The options of task, reward and robot (OptionScope::kTask) that keywords, named as above, give
/// another value than the default or name themselves, in the order of the table.
[[nodiscard]] std::vector<OptionText> taskTextsOf(const py::dict& keywords);

/// Such texts as keywords with their values.
[[nodiscard]] py::dict keywordsOf(const std::vector<OptionText>& task_texts);

/// All options of the table as keywords with their values.
[[nodiscard]] py::dict keywordsOf(const SimulationOptions& options);

/// Those that are noise of the robot (OptionScope::kRobotNoise), as keywords.
[[nodiscard]] std::vector<std::string> robotNoiseKeywords();

/// Throws the TypeError of a keyword that is none of `known`, with the nearest of them.
[[noreturn]] void refuseKeyword(const std::string& keyword, const std::vector<std::string>& known);

}  // namespace galactic::python
