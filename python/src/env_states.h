#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "galactic/batch_simulator.h"
#include "simulator.h"

namespace galactic::python {

/// galactic.EnvState: an EnvState with the names of its objects.
struct NamedEnvState : EnvState {
  std::vector<std::string> object_names;
};

/// The state of one env.
[[nodiscard]] NamedEnvState envState(Simulator& simulator, const py::object& env);

/// The galactic.EnvStates of the envs in a list, or of all for None.
[[nodiscard]] py::object envStates(Simulator& simulator, const py::object& envs);

/// Raises TypeError for anything but a galactic.EnvStates.
void requireStates(const py::object& states);

/// Raises what setStates() would raise for these galactic.EnvStates, and does nothing else.
void checkStates(Simulator& simulator, const py::object& states);

/// Sets the envs in a list, or all for None, to galactic.EnvStates. Returns bool (n,): which envs
/// were set.
[[nodiscard]] py::array_t<bool> setStates(Simulator& simulator, const py::object& states,
                                          const py::object& envs, bool are_drawn);

}  // namespace galactic::python
