#pragma once
#include <pybind11/pybind11.h>

namespace galactic::python {

namespace py = pybind11;

/// For calls with wrong arguments to methods and constructors of the module's classes, makes the
/// message of the TypeError a single sentence, with the expected arguments and the types of those
/// found. Otherwise pybind11 lists C++ signatures and prints whole arrays.
void refuseOtherCalls(const py::module_& module);

/// Makes the use of an object whose __init__() was not called raise a TypeError: for example, one
/// from World.__new__(World), or of a subclass that has not called it yet. Otherwise pybind11 would
/// use uninitialized memory as the object.
void refuseBlankObjects(const py::module_& module);

}  // namespace galactic::python
