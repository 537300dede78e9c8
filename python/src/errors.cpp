
#include <exception>

#include "bindings.h"
#include "galactic/error.h"

namespace galactic::python {
namespace {

/// Turns an ErrorException, which may be thrown without the interpreter's lock, into a
/// galactic.Error.
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const ErrorException& refusal) {
    const Error& error = refusal.error();
    const py::object type = py::module_::import("galactic.errors").attr("Error");
    const py::object raised =
        type(static_cast<int>(error.code), fileText(error.where), fileText(error.message));
    PyErr_SetObject(type.ptr(), raised.ptr());
  }
}

}  // namespace

void bindErrors(py::module_& module) {
  bindEnum(module, "ErrorCode",
           {{"IO", static_cast<int>(ErrorCode::kIo)},
            {"INVALID_INPUT", static_cast<int>(ErrorCode::kInvalidInput)},
            {"INTERNAL", static_cast<int>(ErrorCode::kInternal)},
            {"UNSUPPORTED", static_cast<int>(ErrorCode::kUnsupported)},
            {"INTERRUPTED", static_cast<int>(ErrorCode::kInterrupted)}},
           "Why something failed. The values are the exit codes of galactic's programs.");
  py::register_exception_translator(&translate);
}

}  // namespace galactic::python
