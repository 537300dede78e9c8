// Stands in for cuda_mapping.cpp where CUDA's headers are not found.
#include "render/gl/cuda_mapping.h"

namespace galactic::render::gl {

struct CudaMapping::Driver {};

CudaMapping::CudaMapping() = default;
CudaMapping::~CudaMapping() = default;

Result<MappedBuffer> CudaMapping::map(std::uint32_t /*buffer*/, std::uintptr_t /*stream*/) {
  return fail(ErrorCode::kUnsupported, "device images",
              "this program was built without CUDA; build it where CMake finds cuda.h (Debian: "
              "nvidia-cuda-toolkit), or render to memory of the processor");
}
void CudaMapping::unmap() {}
void CudaMapping::forget() {}

}  // namespace galactic::render::gl
