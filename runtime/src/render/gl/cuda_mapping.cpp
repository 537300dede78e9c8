// CUDA is loaded when it is first asked for: the program neither links nor needs it.
#include "render/gl/cuda_mapping.h"

#include <cuda.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <bit>

#include "render/gl/handles.h"

namespace galactic::render::gl {

/// The functions of CUDA's driver that are used, by their names in libcuda.so.1.
struct CudaMapping::Driver {
  CUresult (*current)(CUcontext*) = nullptr;
  CUresult (*device)(CUdevice*) = nullptr;
  CUresult (*register_buffer)(CUgraphicsResource*, unsigned, unsigned) = nullptr;
  CUresult (*unregister)(CUgraphicsResource) = nullptr;
  CUresult (*map)(unsigned, CUgraphicsResource*, CUstream) = nullptr;
  CUresult (*unmap)(unsigned, CUgraphicsResource*, CUstream) = nullptr;
  CUresult (*address)(CUdeviceptr*, std::size_t*, CUgraphicsResource) = nullptr;
  CUresult (*synchronize)(CUstream) = nullptr;

  std::uint32_t buffer = 0;
  CUgraphicsResource resource = nullptr;
  /// That the buffer is mapped for.
  CUstream stream = nullptr;
  bool mapped = false;
};

namespace {

tl::unexpected<Error> refused(const std::string& message) {
  return fail(ErrorCode::kUnsupported, "device images", message);
}

template <class Function>
bool find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  return function != nullptr;
}

}  // namespace

CudaMapping::CudaMapping() = default;
CudaMapping::~CudaMapping() { forget(); }

Result<MappedBuffer> CudaMapping::map(std::uint32_t buffer, std::uintptr_t stream) {
  if (driver_ == nullptr) {
    void* library = dlopen("libcuda.so.1", RTLD_LAZY | RTLD_LOCAL);
    if (library == nullptr) return refused("found no libcuda.so.1; install NVIDIA's driver");
    auto driver = std::make_unique<Driver>();
    const bool complete = find(library, "cuCtxGetCurrent", driver->current) &&
                          find(library, "cuCtxGetDevice", driver->device) &&
                          find(library, "cuGraphicsGLRegisterBuffer", driver->register_buffer) &&
                          find(library, "cuGraphicsUnregisterResource", driver->unregister) &&
                          find(library, "cuGraphicsMapResources", driver->map) &&
                          find(library, "cuGraphicsUnmapResources", driver->unmap) &&
                          find(library, "cuGraphicsResourceGetMappedPointer_v2", driver->address) &&
                          find(library, "cuStreamSynchronize", driver->synchronize);
    if (!complete) return refused("libcuda.so.1 is too old to share buffers with OpenGL");
    driver_ = std::move(driver);
  }
  CUcontext context = nullptr;
  CUdevice device = 0;
  if (driver_->current(&context) != CUDA_SUCCESS || context == nullptr ||
      driver_->device(&device) != CUDA_SUCCESS) {
    return refused("no CUDA context is current on this thread; make one first");
  }
  if (driver_->buffer != buffer) {
    forget();
    // Only OpenGL writes.
    const CUresult result =
        driver_->register_buffer(&driver_->resource, buffer, CU_GRAPHICS_REGISTER_FLAGS_READ_ONLY);
    if (result != CUDA_SUCCESS) {
      return refused(
          fmt::format("CUDA cannot share OpenGL's buffer (error {}): the renderer's "
                      "device must be the one of the current CUDA context, see "
                      "RenderOptions::device",
                      static_cast<int>(result)));
    }
    driver_->buffer = buffer;
  }
  CUdeviceptr address = 0;
  std::size_t size = 0;
  driver_->stream = std::bit_cast<CUstream>(stream);
  CUresult result = driver_->map(1, &driver_->resource, driver_->stream);
  if (result == CUDA_SUCCESS) {
    driver_->mapped = true;
    result = driver_->address(&address, &size, driver_->resource);
  }
  // Other streams may use it, too.
  if (result == CUDA_SUCCESS) result = driver_->synchronize(driver_->stream);
  if (result != CUDA_SUCCESS) {
    return refused(
        fmt::format("CUDA cannot map OpenGL's buffer (error {})", static_cast<int>(result)));
  }
  // CUDA's devices are numbered as its handles of them are.
  return MappedBuffer{static_cast<std::uint64_t>(address), static_cast<int>(device)};
}

void CudaMapping::unmap() {
  if (driver_ == nullptr || !driver_->mapped) return;
  driver_->unmap(1, &driver_->resource, driver_->stream);
  driver_->mapped = false;
}

void CudaMapping::forget() {
  if (driver_ == nullptr || driver_->buffer == 0) return;
  if (hasContext()) {
    unmap();
    driver_->unregister(driver_->resource);
  }
  driver_->mapped = false;
  driver_->buffer = 0;
}

}  // namespace galactic::render::gl
