#pragma once
#include <pybind11/pybind11.h>

#include "galactic/world.h"

namespace galactic::python {

namespace py = pybind11;

/// A galactic.EpisodeTable of all episodes of a world.
[[nodiscard]] py::object episodeTableOf(const World& world);

}  // namespace galactic::python
