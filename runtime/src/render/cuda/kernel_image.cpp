#include "render/cuda/kernel_image.h"

// The kernels are one long string.
#pragma GCC diagnostic ignored "-Woverlength-strings"
#include "render/cuda/ptx_texts.h"

namespace galactic::render::cuda {

const char* kernelImage() { return kPtxDevice; }

}  // namespace galactic::render::cuda
