// galactic._core: thin, typed bindings of the library's classes. Uses numpy and DLPack, but not
// torch.
#include <string>

#include "bindings.h"
#include "calls.h"

namespace galactic::python {

void bindEnum(py::module_& module, const char* name,
              const std::vector<std::pair<std::string, int>>& values, const char* documentation) {
  py::dict members;
  for (const auto& [member, value] : values) members[py::str(member)] = value;
  const py::object make = py::module_::import("enum").attr("IntEnum");
  const py::object type = make(name, members, py::arg("module") = "galactic");
  type.attr("__doc__") = documentation;
  module.attr(name) = type;
}

py::str fileText(std::string_view text) {
  PyObject* decoded =
      PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "replace");
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

void refusePickling(const py::object& type, const char* instead) {
  const std::string message = "a galactic." + py::str(type.attr("__name__")).cast<std::string>() +
                              " cannot be pickled or copied: " + instead;
  type.attr("__reduce_ex__") = py::cpp_function(
      [message](const py::object&, const py::object&) -> py::object {
        throw py::type_error(message);
      },
      py::is_method(type));
}

}  // namespace galactic::python

PYBIND11_MODULE(_core, module) {
  module.doc() = "The compiled part of galactic; import galactic instead.";
  module.attr("__version__") = GALACTIC_VERSION;
  galactic::python::bindErrors(module);
  galactic::python::bindWorld(module);
  galactic::python::bindEnvState(module);
  galactic::python::bindSimulator(module);
  galactic::python::bindPlanningScene(module);
  galactic::python::bindPathFinder(module);
  galactic::python::bindRayCaster(module);
  galactic::python::bindEpisodeTally(module);
  galactic::python::bindPolicy(module);
  galactic::python::bindScriptedPolicy(module);
  galactic::python::bindRenderer(module);
  galactic::python::refuseOtherCalls(module);
  galactic::python::refuseBlankObjects(module);
}
