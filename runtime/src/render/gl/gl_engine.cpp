#include "render/gl/gl_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "support/try.h"

namespace galactic::render::gl {
namespace {

Error lostContext(const CurrentContext& current) {
  return {ErrorCode::kUnsupported, "render device",
          fmt::format("EGL no longer has the renderer's context (EGL error 0x{:04x}): another part "
                      "of the program may have closed the display (eglTerminate); make another "
                      "renderer, or use the soft backend",
                      current.error())};
}

}  // namespace

Result<std::unique_ptr<GlEngine>> GlEngine::make(const RenderLibrary& library,
                                                 const RenderOptions& options,
                                                 const GlTuning& tuning,
                                                 const LibraryLoads& loads) {
  ASSIGN_OR_RETURN(const DeviceWish wish, parseDeviceWish(options.device));
  RETURN_IF_ERROR(checkLibraries(loads));
  ASSIGN_OR_RETURN(EglContext context, openContext(wish, options.backend == RenderBackend::kGl));
  const CurrentContext current(context);
  if (!current.holds()) return tl::unexpected<Error>(lostContext(current));
  ASSIGN_OR_RETURN(auto renderer, GlRenderer::make(library, options, tuning));
  return std::make_unique<GlEngine>(std::move(context), std::move(renderer));
}

GlEngine::~GlEngine() {
  const CurrentContext current(context_);
  for (ViewSlice& slice : slices_) {
    if (slice.fence != nullptr && current.holds()) glDeleteSync(slice.fence);
    slice = ViewSlice();
  }
  cuda_.reset();
  renderer_.reset();
}

void GlEngine::begin(std::span<const RenderView> views, const RenderTargets& targets) {
  views_ = views;
  targets_ = targets;
  submitted_views_ = 0;
  submitted_slices_ = 0;
  collected_slices_ = 0;
  const CurrentContext current(context_);
  if (!current.holds()) throw ErrorException(lostContext(current));
  // A batch that failed leaves slices behind, whose buffers are in use until the slices are drawn.
  finishSlices();
  renderer_->resetStatistics();
  submitNext();
}

void GlEngine::end() {
  // A batch without views has nothing to wait for.
  if (collected_slices_ == submitted_slices_) return;
  const CurrentContext current(context_);
  if (!current.holds()) throw ErrorException(lostContext(current));
  while (collected_slices_ < submitted_slices_) {
    renderer_->collect(slices_[collected_slices_ % slices_.size()], targets_);
    ++collected_slices_;
    submitNext();
  }
}

void GlEngine::submitNext() {
  while (submitted_views_ < views_.size() &&
         submitted_slices_ - collected_slices_ < slices_.size()) {
    ViewSlice& slice = slices_[submitted_slices_ % slices_.size()];
    const std::size_t count = std::min(renderer_->mostViews(), views_.size() - submitted_views_);
    slice.first_view = submitted_views_;
    try {
      renderer_->submit(views_.subspan(submitted_views_, count), slice);
    } catch (...) {
      // end() has to collect the slices that were submitted, but none of the other views.
      views_ = {};
      throw;
    }
    submitted_views_ += count;
    ++submitted_slices_;
  }
}

void GlEngine::finishSlices() {
  for (ViewSlice& slice : slices_) {
    if (slice.fence != nullptr) renderer_->finish(slice);
  }
}

Result<ImageLayout> GlEngine::drawToDevice(std::span<const RenderView> views) {
  // Slices that a failed batch left behind must not be collected.
  collected_slices_ = submitted_slices_;
  const CurrentContext current(context_);
  if (!current.holds()) return tl::unexpected<Error>(lostContext(current));
  finishSlices();
  cuda_->unmap();
  renderer_->resetStatistics();
  // CUDA must let go of a buffer before it is replaced by a larger one.
  if (!renderer_->hasRoomOnDevice(views.size())) cuda_->forget();
  Result<ImageLayout> layout = renderer_->reserveDeviceImages(views.size());
  if (!layout) return layout;
  // Four pixels of three bytes are written together; slices must not share such a group.
  constexpr std::size_t kTogether = 4;
  const std::size_t most = std::max(renderer_->mostViews() / kTogether, std::size_t{1}) * kTogether;
  std::size_t next = 0;
  for (std::size_t first = 0; first < views.size(); first += most, ++next) {
    ViewSlice& slice = slices_[next % slices_.size()];
    if (slice.fence != nullptr) renderer_->finish(slice);
    slice.first_view = first;
    renderer_->submitToDevice(views.subspan(first, std::min(most, views.size() - first)), *layout,
                              slice);
  }
  finishSlices();
  return layout;
}

Result<DeviceImages> GlEngine::renderToDevice(std::span<const RenderView> views,
                                              std::uintptr_t stream) {
  ASSIGN_OR_RETURN(const ImageLayout layout, drawToDevice(views));
  const CurrentContext current(context_);
  if (!current.holds()) return tl::unexpected<Error>(lostContext(current));
  ASSIGN_OR_RETURN(const MappedBuffer mapped, cuda_->map(renderer_->deviceImages().get(), stream));
  DeviceImages images{.device = mapped.device};
  if (layout.color_of_view > 0) images.color = mapped.address + layout.color;
  if (layout.depth_of_view > 0) images.depth = mapped.address + layout.depth;
  if (layout.semantics_of_view > 0) images.semantics = mapped.address + layout.semantics;
  return images;
}

std::string GlEngine::description() const {
  const ContextFacts& facts = context_.facts();
  return "gl, " + facts.renderer + ", OpenGL " + std::to_string(facts.major) + "." +
         std::to_string(facts.minor);
}

}  // namespace galactic::render::gl

namespace galactic::render {

Result<std::unique_ptr<RenderEngine>> makeGlEngine(const RenderLibrary& library,
                                                   const RenderOptions& options) {
  ASSIGN_OR_RETURN(auto engine, gl::GlEngine::make(library, options, {}, gl::loadsLibrary));
  return std::unique_ptr<RenderEngine>(std::move(engine));
}

}  // namespace galactic::render
