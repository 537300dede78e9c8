#pragma once
#include <pybind11/pybind11.h>

#include "galactic/world.h"

namespace galactic::python {

namespace py = pybind11;

/// What all episodes of a world are about: a galactic.EpisodeTable.
[[nodiscard]] py::object episodeTableOf(const World& world);

}  // namespace galactic::python
