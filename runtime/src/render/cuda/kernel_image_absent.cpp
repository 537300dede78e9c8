// Stands in for kernel_image.cpp where there is no clang to compile the kernels.
#include "render/cuda/kernel_image.h"

namespace galactic::render::cuda {

const char* kernelImage() { return nullptr; }

}  // namespace galactic::render::cuda
