#pragma once
#include <cstddef>
#include <span>

#include "galactic/batch_renderer.h"

namespace galactic::render {

/// Throws ErrorException with kInvalidInput where a view has the number of no model, a model on a
/// body that it does not have, or semantic ids for another number of posed models than its own.
/// `call`: "BatchRenderer::render"; `models`: RenderLibrary::modelCount(). Does not allocate,
/// unless it throws.
void checkViews(const char* call, std::span<const RenderView> views, std::size_t models);

}  // namespace galactic::render
