#include "render/gl/egl_library.h"

#include <dlfcn.h>

namespace galactic::render::gl {
namespace {

tl::unexpected<Error> missing(const char* message) {
  return fail(ErrorCode::kUnsupported, "render backend gl", message);
}

}  // namespace

bool loadsLibrary(const char* name) {
  // Never closed: drivers do not like to be unloaded.
  return dlopen(name, RTLD_LAZY | RTLD_LOCAL) != nullptr;
}

Result<void> checkLibraries(const LibraryLoads& loads) {
  if (!loads("libEGL.so.1")) {
    return missing(
        "found no libEGL.so.1; install libegl1 (and libgl1-mesa-dri for the software driver), or "
        "use the soft backend");
  }
  if (!loads("libOpenGL.so.0") && !loads("libGL.so.1")) {
    return missing(
        "found neither libOpenGL.so.0 nor libGL.so.1; install libopengl0, or use the soft "
        "backend");
  }
  return {};
}

}  // namespace galactic::render::gl
