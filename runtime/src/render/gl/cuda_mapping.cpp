#include "render/gl/cuda_mapping.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <bit>
#include <cstddef>

#include "render/cuda_symbols.h"
#include "render/gl/handles.h"

namespace galactic::render::gl {

/// The functions of CUDA's driver that are used.
struct CudaMapping::Driver {
  int (*current)(void** context) = nullptr;
  int (*device)(int* device) = nullptr;
  int (*register_buffer)(void** resource, unsigned buffer, unsigned flags) = nullptr;
  int (*unregister)(void* resource) = nullptr;
  int (*map)(unsigned count, void** resources, void* stream) = nullptr;
  int (*unmap)(unsigned count, void** resources, void* stream) = nullptr;
  int (*address)(std::uint64_t* address, std::size_t* bytes, void* resource) = nullptr;
  int (*synchronize)(void* stream) = nullptr;

  std::uint32_t buffer = 0;
  void* resource = nullptr;
  /// The stream for which the buffer is mapped.
  void* stream = nullptr;
  bool mapped = false;
};

namespace {

tl::unexpected<Error> refused(const std::string& message) {
  return fail(ErrorCode::kUnsupported, "device images", message);
}

}  // namespace

CudaMapping::CudaMapping() = default;
CudaMapping::~CudaMapping() { forget(); }

Result<MappedBuffer> CudaMapping::map(std::uint32_t buffer, std::uintptr_t stream) {
  if (driver_ == nullptr) {
    void* library = dlopen(kCudaLibrary, RTLD_LAZY | RTLD_LOCAL);
    if (library == nullptr) {
      return refused(fmt::format("found no {}; install NVIDIA's driver", kCudaLibrary));
    }
    auto driver = std::make_unique<Driver>();
    CudaSymbols symbols(library);
    symbols.find("cuCtxGetCurrent", driver->current);
    symbols.find("cuCtxGetDevice", driver->device);
    symbols.find("cuGraphicsGLRegisterBuffer", driver->register_buffer);
    symbols.find("cuGraphicsUnregisterResource", driver->unregister);
    symbols.find("cuGraphicsMapResources", driver->map);
    symbols.find("cuGraphicsUnmapResources", driver->unmap);
    symbols.find("cuGraphicsResourceGetMappedPointer_v2", driver->address);
    symbols.find("cuStreamSynchronize", driver->synchronize);
    if (const char* missing = symbols.missing()) {
      return refused(fmt::format("{} is too old to share buffers with OpenGL: it has no {}",
                                 kCudaLibrary, missing));
    }
    driver_ = std::move(driver);
  }
  void* context = nullptr;
  int device = 0;
  if (driver_->current(&context) != 0 || context == nullptr || driver_->device(&device) != 0) {
    return refused("no CUDA context is current on this thread; make one first");
  }
  if (driver_->buffer != buffer) {
    forget();
    // CU_GRAPHICS_REGISTER_FLAGS_READ_ONLY: only OpenGL writes.
    constexpr unsigned kReadOnly = 1;
    const int result = driver_->register_buffer(&driver_->resource, buffer, kReadOnly);
    if (result != 0) {
      return refused(
          fmt::format("CUDA cannot share OpenGL's buffer (error {}): the renderer's "
                      "device must be the one of the current CUDA context, see "
                      "RenderOptions::device",
                      result));
    }
    driver_->buffer = buffer;
  }
  std::uint64_t address = 0;
  std::size_t size = 0;
  driver_->stream = std::bit_cast<void*>(stream);
  int result = driver_->map(1, &driver_->resource, driver_->stream);
  if (result == 0) {
    driver_->mapped = true;
    result = driver_->address(&address, &size, driver_->resource);
  }
  // Other streams may use the buffer too.
  if (result == 0) result = driver_->synchronize(driver_->stream);
  if (result != 0) {
    return refused(fmt::format("CUDA cannot map OpenGL's buffer (error {})", result));
  }
  // A device handle of CUDA's driver is also the number of the device.
  return MappedBuffer{address, device};
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
