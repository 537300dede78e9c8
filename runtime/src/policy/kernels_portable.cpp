#include "policy/kernels.h"
#include "support/processor.h"

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

Kernels kernels() noexcept { return detail::hasFusedAvx2() ? avx2Kernels() : portableKernels(); }

}  // namespace galactic::policy
