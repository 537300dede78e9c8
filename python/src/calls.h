#pragma once
#include <pybind11/pybind11.h>

namespace galactic::python {

namespace py = pybind11;

/// Makes the TypeErrors of all calls that do not fit, to the methods and constructors of the
/// module's classes, one sentence: what is taken, and the types of what was found. Otherwise
/// pybind11 lists C++ signatures and prints whole arrays.
void refuseOtherCalls(const py::module_& module);

/// Makes the use of an object of the module's classes whose __init__() was not called a TypeError:
/// one of World.__new__(World), or of a subclass that has not called it yet. Otherwise pybind11
/// takes memory that nothing is in for the object.
void refuseBlankObjects(const py::module_& module);

}  // namespace galactic::python
