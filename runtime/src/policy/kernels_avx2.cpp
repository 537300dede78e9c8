// Compiled for AVX2 and FMA; instantiates no library templates, see column_grid_avx2.cpp.
#include "policy/kernels.h"

#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>

namespace galactic::policy {
namespace {

using Lanes = float __attribute__((vector_size(32)));

inline Lanes fused(Lanes a, Lanes b, Lanes c) { return _mm256_fmadd_ps(a, b, c); }
inline Lanes squareRoot(Lanes a) { return _mm256_sqrt_ps(a); }

}  // namespace
}  // namespace galactic::policy

#include "policy/kernels.inl"

namespace galactic::policy {

Kernels avx2Kernels() noexcept { return listKernels(); }

}  // namespace galactic::policy

#else

namespace galactic::policy {

// hasFusedAvx2() is false on this architecture; the symbol exists so that callers need no
// condition.
Kernels avx2Kernels() noexcept { return portableKernels(); }

}  // namespace galactic::policy

#endif
