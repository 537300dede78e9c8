#pragma once
#include <functional>

#include "galactic/error.h"

namespace galactic::render::gl {

/// Whether the dynamic linker can load a library, and keeps it loaded.
using LibraryLoads = std::function<bool(const char* name)>;

/// Loads with dlopen.
[[nodiscard]] bool loadsLibrary(const char* name);

/// Whether EGL and OpenGL are installed. To be asked before the first call into libepoxy, which
/// ends the program where they are not. Fails with kUnsupported and names the Debian package.
[[nodiscard]] Result<void> checkLibraries(const LibraryLoads& loads);

}  // namespace galactic::render::gl
