#pragma once

namespace galactic::render::cuda {

/// The kernels as PTX for compute capability 7.0 or 7.5, which the driver compiles for its device
/// and caches. Null if the build had no compiler for them.
[[nodiscard]] const char* kernelImage();

}  // namespace galactic::render::cuda
