// Stands in for kernel_image.cpp if the build has no compiler for the kernels.
#include "render/cuda/kernel_image.h"

namespace galactic::render::cuda {

const char* kernelImage() { return nullptr; }

}  // namespace galactic::render::cuda
