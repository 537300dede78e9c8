#include "policy/kernels.h"

namespace galactic::policy {
namespace {

using Lanes = float __attribute__((vector_size(32)));

inline Lanes fused(Lanes a, Lanes b, Lanes c) {
  for (int n = 0; n < 8; ++n) c[n] = __builtin_fmaf(a[n], b[n], c[n]);
  return c;
}
inline Lanes squareRoot(Lanes a) {
  for (int n = 0; n < 8; ++n) a[n] = __builtin_sqrtf(a[n]);
  return a;
}

}  // namespace
}  // namespace galactic::policy

#include "policy/kernels.inl"

namespace galactic::policy {

Kernels portableKernels() noexcept { return listKernels(); }

bool hasFusedAvx2() noexcept {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
#else
  return false;
#endif
}

Kernels kernels() noexcept { return hasFusedAvx2() ? avx2Kernels() : portableKernels(); }

}  // namespace galactic::policy
