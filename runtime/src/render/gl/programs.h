#pragma once
#include "galactic/error.h"
#include "render/gl/handles.h"
#include "render/gl/shader_sources.h"

namespace galactic::render::gl {

/// All programs of a renderer.
struct Programs {
  Program opaque;
  Program masked;
  Program test;
  Program scan;
  Program emit;
  Program resolve;
};

/// Compiles and links them on the current context. Fails with kInternal and the driver's message.
[[nodiscard]] Result<Programs> makePrograms(const ShaderVariant& variant);

}  // namespace galactic::render::gl
