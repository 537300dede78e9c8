#pragma once

namespace galactic::detail {

// Features of this processor beyond the baseline of its architecture. Inlined everywhere: callers
// ask before each small kernel, and code built for AVX2 must not share a function with code for any
// processor.

/// Whether code built for AVX2 can run here.
[[nodiscard, gnu::always_inline]] inline bool hasAvx2() noexcept {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

/// Whether code built for AVX2 and fused multiplication (FMA) can run here.
[[nodiscard, gnu::always_inline]] inline bool hasFusedAvx2() noexcept {
#if defined(__x86_64__)
  return hasAvx2() && __builtin_cpu_supports("fma") != 0;
#else
  return false;
#endif
}

/// Whether code built for AVX-512 (F, BW, DQ, VL) and the bit instructions (BMI, BMI2) can run
/// here.
[[nodiscard, gnu::always_inline]] inline bool hasAvx512() noexcept {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
         __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
         __builtin_cpu_supports("bmi") != 0 && __builtin_cpu_supports("bmi2") != 0;
#else
  return false;
#endif
}

}  // namespace galactic::detail
