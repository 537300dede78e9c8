#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "galactic/batch_simulator.h"
#include "simulator.h"

namespace galactic::python {

/// galactic.EnvState: with what the objects are called.
struct NamedEnvState : EnvState {
  std::vector<std::string> object_names;
};

/// Of one env.
[[nodiscard]] NamedEnvState envState(Simulator& simulator, const py::object& env);

/// The galactic.EnvStates of all envs, for None, or of a list of them.
[[nodiscard]] py::object envStates(Simulator& simulator, const py::object& envs);

/// TypeError for what is no galactic.EnvStates.
void requireStates(const py::object& states);

/// Raises what setStates() would raise because of galactic.EnvStates, and does nothing else.
void checkStates(Simulator& simulator, const py::object& states);

/// Envs go on from galactic.EnvStates, all of them for None, or those of a list: bool (n,), where.
[[nodiscard]] py::array_t<bool> setStates(Simulator& simulator, const py::object& states,
                                          const py::object& envs, bool are_drawn);

}  // namespace galactic::python
