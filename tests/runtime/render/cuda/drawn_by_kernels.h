#pragma once
#include <dlfcn.h>

#include <memory>
#include <span>
#include <stdexcept>
#include <utility>

#include "render/cuda/cuda_engine.h"
#include "render/cuda/kernel_image.h"
#include "standin.h"
#include "support/build_paths.h"
#include "support/render_images.h"

namespace galactic::test {

/// Whether the library carries the kernels.
inline bool hasKernels() { return render::cuda::kernelImage() != nullptr; }

/// The stand-in's state, reset.
inline Standin& resetStandin() {
  using Get = Standin* (*)();
  void* const library = dlopen(cudaStandIn().c_str(), RTLD_NOW);
  if (library == nullptr) throw std::runtime_error(dlerror());
  const auto get = reinterpret_cast<Get>(dlsym(library, "galactic_standin"));
  Standin& standin = *get();
  Standin fresh;
  fresh.allocations = standin.allocations;
  fresh.allocated_bytes = standin.allocated_bytes;
  fresh.contexts = standin.contexts;
  fresh.modules = standin.modules;
  fresh.shared_buffers = standin.shared_buffers;
  fresh.mapped_buffers = standin.mapped_buffers;
  standin = fresh;
  return standin;
}

inline Result<std::unique_ptr<render::cuda::CudaEngine>> makeEngine(
    const RenderLibrary& library, const RenderOptions& options,
    std::size_t slice_bytes = 1U << 30U) {
  return render::cuda::CudaEngine::make(library, options,
                                        {.library = cudaStandIn(), .slice_bytes = slice_bytes});
}

/// What the kernels draw, run on the processor.
inline RenderImages drawWithKernels(const RenderLibrary& library, const RenderOptions& options,
                                    std::span<const RenderView> views,
                                    std::size_t slice_bytes = 1U << 30U) {
  auto engine = makeEngine(library, options, slice_bytes);
  if (!engine) throw std::runtime_error(engine.error().message);
  RenderImages images = emptyImages(options, views.size());
  (*engine)->begin(views, targetsOf(images));
  (*engine)->end();
  return images;
}

inline RenderImages drawWithSoft(const RenderLibrary& library, RenderOptions options,
                                 std::span<const RenderView> views) {
  options.backend = RenderBackend::kSoft;
  options.threads = 1;
  return renderViews(library, options, views);
}

}  // namespace galactic::test
