#pragma once

namespace galactic::render::cuda {

/// The kernels as PTX for compute capability 7.0, which the driver compiles for its device and
/// keeps in its cache. Null where the build had no clang.
[[nodiscard]] const char* kernelImage();

}  // namespace galactic::render::cuda
