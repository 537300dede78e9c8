#pragma once
#include <pybind11/pybind11.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace galactic::python {

namespace py = pybind11;

/// The parts of the module, in the order in which they must be bound.
void bindErrors(py::module_& module);
void bindWorld(py::module_& module);
void bindEnvState(py::module_& module);
void bindSimulator(py::module_& module);
void bindPlanningScene(py::module_& module);
void bindPathFinder(py::module_& module);
void bindRayCaster(py::module_& module);
void bindEpisodeTally(py::module_& module);
void bindPolicy(py::module_& module);
void bindScriptedPolicy(py::module_& module);
void bindRenderer(py::module_& module);

/// Text from a file, such as a name in a pack. Bytes that are not UTF-8, as in some file names,
/// become U+FFFD.
[[nodiscard]] py::str fileText(std::string_view text);

/// Adds an enum.IntEnum to the module; arrays hold its values as numbers.
void bindEnum(py::module_& module, const char* name,
              const std::vector<std::pair<std::string, int>>& values, const char* documentation);

/// Makes pickling and copying objects of a class raise a TypeError that says what to do `instead`.
void refusePickling(const py::object& type, const char* instead);

}  // namespace galactic::python
