#pragma once
#include <cstdint>
#include <memory>

#include "galactic/error.h"

namespace galactic::render::gl {

/// A buffer of OpenGL in CUDA's memory.
struct MappedBuffer {
  std::uint64_t address = 0;
  /// CUDA's number of the device.
  int device = 0;
};

/// Gives CUDA the memory of a buffer of OpenGL, without a copy. The OpenGL context must be current
/// for all calls, also for the destructor, unless it is lost.
class CudaMapping {
 public:
  CudaMapping();
  ~CudaMapping();
  CudaMapping(const CudaMapping&) = delete;
  CudaMapping& operator=(const CudaMapping&) = delete;

  /// `buffer` after all that OpenGL has been told to do with it, which is done when this returns.
  /// What `stream` does with it ends before unmap() lets OpenGL have it again.
  /// CUDA's context must be current on this thread. OpenGL must not touch the buffer until
  /// unmap(). Fails with kUnsupported where CUDA is absent or is on another device.
  [[nodiscard]] Result<MappedBuffer> map(std::uint32_t buffer, std::uintptr_t stream);
  /// OpenGL may use the buffer again, after all that the stream has been told to do with it.
  void unmap();
  /// To be called before a buffer is deleted.
  void forget();

 private:
  struct Driver;
  std::unique_ptr<Driver> driver_;
};

}  // namespace galactic::render::gl
