#pragma once
#include <cstddef>
#include <span>

#include "galactic/batch_renderer.h"

namespace galactic::render {

/// Throws ErrorException with kInvalidInput if a view names a model or a body that does not exist,
/// or if it has semantic ids, but not one for each posed model. `call`: the name of the calling
/// function, such as "BatchRenderer::render"; `models`: RenderLibrary::modelCount(). Allocates only
/// if it throws.
void checkViews(const char* call, std::span<const RenderView> views, std::size_t models);

}  // namespace galactic::render
