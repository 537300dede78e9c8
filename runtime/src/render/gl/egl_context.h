#pragma once
#include <epoxy/egl.h>

#include <functional>
#include <utility>
#include <vector>

#include "galactic/error.h"
#include "render/device_wish.h"

namespace galactic::render::gl {

/// Whether the dynamic linker can load a library, and keeps it loaded.
using LibraryLoads = std::function<bool(const char* name)>;

/// Loads with dlopen.
[[nodiscard]] bool loadsLibrary(const char* name);

/// Whether EGL and OpenGL are installed. To be asked before the first call into libepoxy, which
/// ends the program where they are not. Fails with kUnsupported and names the Debian package.
[[nodiscard]] Result<void> checkLibraries(const LibraryLoads& loads);

/// An OpenGL context that needs no display and no surface. Movable. Its EGL display is never
/// closed, because other contexts of the program may share it.
class EglContext {
 public:
  EglContext() = default;
  /// Owns `context`.
  EglContext(EGLDisplay display, EGLContext context) : display_(display), context_(context) {}
  ~EglContext();
  EglContext(EglContext&& other) noexcept;
  EglContext& operator=(EglContext&& other) noexcept;

  [[nodiscard]] EGLDisplay display() const { return display_; }
  [[nodiscard]] EGLContext handle() const { return context_; }
  [[nodiscard]] const ContextFacts& facts() const { return facts_; }
  void setFacts(ContextFacts facts) { facts_ = std::move(facts); }

 private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  ContextFacts facts_;
};

/// Makes a context current on this thread for a scope, and then what was current before: the caller
/// may draw with OpenGL himself, and may call from another thread the next time. Where EGL refuses,
/// none is current in this scope: nothing must reach the caller's.
class CurrentContext {
 public:
  explicit CurrentContext(const EglContext& context);
  ~CurrentContext();
  /// Whether it worked. It does not once another part of the program has closed the display.
  [[nodiscard]] bool holds() const { return holds_; }
  /// What EGL said to it.
  [[nodiscard]] EGLint error() const { return error_; }
  CurrentContext(const CurrentContext&) = delete;
  CurrentContext& operator=(const CurrentContext&) = delete;

 private:
  EGLDisplay own_display_;
  EGLenum api_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext previous_ = EGL_NO_CONTEXT;
  EGLSurface draw_ = EGL_NO_SURFACE;
  EGLSurface read_ = EGL_NO_SURFACE;
  bool holds_ = false;
  EGLint error_ = EGL_SUCCESS;
};

/// Opens an OpenGL 4.5 core context on the wished device: EGL's device platform first, Mesa's
/// surfaceless platform last. `explain`: whether the name of a driver that was not wished for is
/// worth the time to open it. Fails with kUnsupported, and says what was found.
[[nodiscard]] Result<EglContext> openContext(const DeviceWish& wish, bool explain);

}  // namespace galactic::render::gl
