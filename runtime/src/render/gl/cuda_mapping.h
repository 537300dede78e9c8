#pragma once
#include <cstdint>
#include <memory>

#include "galactic/error.h"

namespace galactic::render::gl {

/// An OpenGL buffer as CUDA addresses it.
struct MappedBuffer {
  std::uint64_t address = 0;
  /// CUDA's number of the device.
  int device = 0;
};

/// Gives CUDA the memory of an OpenGL buffer, without a copy. The OpenGL context must be current
/// during all calls, including the destructor's, unless it is lost.
class CudaMapping {
 public:
  CudaMapping();
  ~CudaMapping();
  CudaMapping(const CudaMapping&) = delete;
  CudaMapping& operator=(const CudaMapping&) = delete;

  /// Maps `buffer`. When this returns, OpenGL has finished everything that it was told to do with
  /// the buffer; OpenGL must not touch it again until unmap(). OpenGL's work after unmap() starts
  /// only when `stream` has finished the work that it has by then. A CUDA context must be current
  /// on this thread. Fails with kUnsupported if CUDA is absent or if the context is on another
  /// device.
  [[nodiscard]] Result<MappedBuffer> map(std::uint32_t buffer, std::uintptr_t stream);
  /// Gives the buffer back to OpenGL; see map().
  void unmap();
  /// Call this before the buffer is deleted.
  void forget();

 private:
  struct Driver;
  std::unique_ptr<Driver> driver_;
};

}  // namespace galactic::render::gl
