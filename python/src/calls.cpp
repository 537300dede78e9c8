#include "calls.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "arrays.h"

namespace galactic::python {
namespace {

/// A first argument of any type, accepted only when pybind11 tries conversions: so its signature is
/// tried after all others of the function.
struct LastResort {
  py::handle value;
};

/// The value if no argument was given.
py::ellipsis nothing() { return {}; }

}  // namespace
}  // namespace galactic::python

namespace pybind11::detail {

template <>
struct type_caster<galactic::python::LastResort> {
  PYBIND11_TYPE_CASTER(galactic::python::LastResort, const_name("object"));
  bool load(handle given, bool convert) {
    value.value = given;
    return convert;
  }
};

}  // namespace pybind11::detail

namespace galactic::python {
namespace {

void replaceAll(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
}

/// Turns pybind11's "step(self: galactic._core.Simulator, actions: object, resets: object = None)
/// -> None" into "actions, resets=None".
std::string parametersIn(std::string_view signature) {
  const std::size_t first = signature.find('(') + 1;
  std::string text(signature.substr(first, signature.rfind(") ->") - first));
  const std::size_t behind_self = text.find(", ");
  text = behind_self == std::string::npos ? "" : text.substr(behind_self + 2);
  replaceAll(text, ": object", "");
  replaceAll(text, "galactic._core.", "galactic.");
  replaceAll(text, " = ", "=");
  return text;
}

/// The types of the given arguments, as "ndarray, reset=int".
std::string typesOf(const LastResort& first, const py::args& others, const py::kwargs& keywords) {
  std::string text;
  const auto add = [&text](const std::string& one) { text += (text.empty() ? "" : ", ") + one; };
  if (!first.value.is(nothing())) add(typeName(first.value));
  for (const auto& value : others) add(typeName(value));
  for (const auto& [name, value] : keywords) add(name.cast<std::string>() + "=" + typeName(value));
  return text;
}

std::string listed(const std::string& text) {
  return text.empty() ? "nothing" : fmt::format("({})", text);
}

/// Adds a last signature to a method, which throws the TypeError. The method keeps its
/// documentation.
void refuseOtherCalls(const py::handle& type, const std::string& name, const py::handle& member) {
  const auto method = py::reinterpret_borrow<py::object>(PyInstanceMethod_Function(member.ptr()));
  const std::string documentation = py::str(method.attr("__doc__"));
  const std::string parameters = parametersIn(documentation.substr(0, documentation.find('\n')));
  const std::string of = py::str(type.attr("__name__"));
  const std::string called = name == "__init__" ? "galactic." + of : of + "." + name;
  const auto refuse = [called, parameters](const py::object&, const LastResort& first,
                                           const py::args& others,
                                           const py::kwargs& keywords) -> py::object {
    throw py::type_error(fmt::format("{}() takes {}, found {}", called, listed(parameters),
                                     listed(typesOf(first, others, keywords))));
  };
  const py::cpp_function added(refuse, py::name(name.c_str()), py::is_method(type),
                               py::sibling(method), py::arg() = nothing());
  // pybind11 has added the new signature to this text, which it allocates and frees in the same
  // way.
  PyMethodDef& definition = *reinterpret_cast<PyCFunctionObject*>(method.ptr())->m_ml;
  std::free(const_cast<char*>(definition.ml_doc));
  definition.ml_doc = strdup(documentation.c_str());
}

/// The classes of the module that pybind11 made, which excludes enums.
std::vector<py::type> classesOf(const py::module_& module) {
  std::vector<py::type> classes;
  for (const auto& [_, member] : py::dict(module.attr("__dict__"))) {
    if (typeName(member) != "pybind11_type") continue;
    classes.push_back(py::reinterpret_borrow<py::type>(member));
  }
  return classes;
}

}  // namespace

void refuseOtherCalls(const py::module_& module) {
  for (const py::type& type : classesOf(module)) {
    for (const auto& [key, member] : py::dict(type.attr("__dict__"))) {
      const auto name = key.cast<std::string>();
      const bool is_called_by_name = name == "__init__" || name.front() != '_';
      const bool is_method = PyInstanceMethod_Check(member.ptr());
      if (is_method && is_called_by_name) refuseOtherCalls(type, name, member);
    }
  }
}

void refuseBlankObjects(const py::module_& module) {
  for (const py::type& type : classesOf(module)) {
    // pybind11 calls this only if it has to pass on an object that was not constructed.
    py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(type.ptr()))->operator_new =
        [](std::size_t) -> void* {
      throw py::type_error(
          "an object of galactic is blank, as its __init__() was not called; make it by calling "
          "its "
          "class, and in a subclass call super().__init__() first");
    };
  }
}

}  // namespace galactic::python
