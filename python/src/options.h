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

/// The value of a keyword as a whole number in a range, a number, a truth value, or text. They
/// throw an ErrorException that says what was found and what was expected, for which truthOf() and
/// wordOf() take `wanted`.
[[nodiscard]] std::uint64_t wholeOf(const char* name, const py::handle& value, std::uint64_t least,
                                    std::uint64_t most);
[[nodiscard]] double numberOf(const char* name, const py::handle& value);
[[nodiscard]] bool truthOf(const char* name, const py::handle& value,
                           const char* wanted = "True or False");
[[nodiscard]] std::string wordOf(const char* name, const py::handle& value, const char* wanted);
/// The value of `threads`.
[[nodiscard]] std::uint32_t threadsOf(const py::handle& value);
/// The value of a number that episodes may draw: a number, a pair of numbers, or text.
[[nodiscard]] DrawnNumber drawnOf(const char* name, const py::handle& value, const Span& within);

/// The keyword for an option of the programs: its name with '_' for '-'.
[[nodiscard]] std::string keywordOf(std::string option);

/// Whether `value` is a truth value of Python or numpy, which would also pass as a whole number.
[[nodiscard]] bool isTruth(const py::handle& value);

/// The options that keywords set: those of the option table with '_' for '-', and `threads`,
/// `body_transforms` and `auto_reset`. Other options have the value in the world's task, or else
/// the default. None counts as not given. Throws an ErrorException for a wrong value and TypeError,
/// with the nearest name, for an unknown keyword.
[[nodiscard]] SimulationOptions optionsOf(const World& world, const py::dict& keywords);

/// The options of task, reward and robot (OptionScope::kTask) that are set by keywords, or that
/// differ from the default because of them, in the order of the table.
[[nodiscard]] std::vector<OptionText> taskTextsOf(const py::dict& keywords);

/// Such texts as a dictionary of keywords.
[[nodiscard]] py::dict keywordsOf(const std::vector<OptionText>& task_texts);

/// All options of the table as a dictionary of keywords.
[[nodiscard]] py::dict keywordsOf(const SimulationOptions& options);

/// The keywords of the options for noise of the robot (OptionScope::kRobotNoise).
[[nodiscard]] std::vector<std::string> robotNoiseKeywords();

/// Throws the TypeError for a keyword that is not among `known`; the message suggests the nearest
/// of them.
[[noreturn]] void refuseKeyword(const std::string& keyword, const std::vector<std::string>& known);

}  // namespace galactic::python
