#pragma once
#include <dlfcn.h>

namespace galactic::render {

/// The library of CUDA's driver. It is opened when it is first needed and stays open: programs
/// neither link it nor need it.
inline constexpr const char* kCudaLibrary = "libcuda.so.1";

/// Looks up functions of CUDA's driver by name. The code that calls them declares their types,
/// since cuda.h comes with a toolkit that users need not have, and the driver's interface is fixed:
/// handles are pointers or numbers of the same size, addresses on a device have 64 bits, and every
/// function returns an int, 0 for success. See "CUDA Driver API" in NVIDIA's manuals.
class CudaSymbols {
 public:
  /// `library`: what dlopen() returned.
  explicit CudaSymbols(void* library) : library_(library) {}

  template <class Function>
  void find(const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(library_, name));
    if (function == nullptr && missing_ == nullptr) missing_ = name;
  }
  /// The first function that was not found; null if all were.
  [[nodiscard]] const char* missing() const { return missing_; }

 private:
  void* library_;
  const char* missing_ = nullptr;
};

}  // namespace galactic::render
