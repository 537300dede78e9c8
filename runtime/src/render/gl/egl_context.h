#pragma once
#include <epoxy/egl.h>

#include <functional>
#include <utility>
#include <vector>

#include "galactic/error.h"
#include "render/device_wish.h"

namespace galactic::render::gl {

/// Loads a library for good; returns whether the dynamic linker could.
using LibraryLoads = std::function<bool(const char* name)>;

/// Loads with dlopen().
[[nodiscard]] bool loadsLibrary(const char* name);

/// Checks that EGL and OpenGL are installed. Call this before any function of libepoxy, which ends
/// the program if they are not. Fails with kUnsupported and names the Debian package.
[[nodiscard]] Result<void> checkLibraries(const LibraryLoads& loads);

/// An OpenGL context that needs neither a screen nor a surface. Movable. Its EGL display is never
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

/// Makes a context current on this thread for a scope, then restores the one that was current
/// before: the caller may use OpenGL too, and may make the next call from another thread. If EGL
/// refuses, no context is current in the scope, so that nothing reaches the caller's context.
class CurrentContext {
 public:
  explicit CurrentContext(const EglContext& context);
  ~CurrentContext();
  /// Whether the context is current. It is not if another part of the program has closed the
  /// display.
  [[nodiscard]] bool holds() const { return holds_; }
  /// EGL's error code if it is not.
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
/// surfaceless platform last. `explain`: whether to spend the time of opening a driver that does
/// not meet the wish, only to name it in the error. Fails with kUnsupported; the message names what
/// was found.
[[nodiscard]] Result<EglContext> openContext(const DeviceWish& wish, bool explain);

}  // namespace galactic::render::gl
