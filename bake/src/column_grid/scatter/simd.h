#pragma once
// Float vectors of the width that the including file is compiled for: 16 lanes with AVX-512, 8 with
// AVX2, 4 otherwise (in plain C++ without SSE). There are only IEEE operations that round each lane
// alone, and no fused ones, so every width computes the same bits.
//
// Everything, even constants (which the linter dislikes), is in an unnamed namespace, and nothing
// of the standard library is used: the linker must never pick a function that was compiled here for
// AVX for the rest of the program.
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace galactic::bake {
namespace {

#if defined(__AVX512F__)
constexpr int kLanes = 16;  // NOLINT(misc-definitions-in-headers)
using Floats = __m512;
using Mask = __mmask16;

inline Floats broadcast(float a) { return _mm512_set1_ps(a); }
inline Floats load(const float* p) { return _mm512_loadu_ps(p); }
inline void store(float* p, Floats a) { _mm512_storeu_ps(p, a); }
inline Floats minimum(Floats a, Floats b) { return _mm512_min_ps(a, b); }
inline Floats maximum(Floats a, Floats b) { return _mm512_max_ps(a, b); }
inline Floats squareRoot(Floats a) { return _mm512_sqrt_ps(a); }
inline Mask less(Floats a, Floats b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
inline Mask both(Mask a, Mask b) { return _kand_mask16(a, b); }
inline Mask either(Mask a, Mask b) { return _kor_mask16(a, b); }
inline Mask without(Mask a, Mask b) { return _kandn_mask16(b, a); }
inline Floats select(Mask m, Floats yes, Floats no) { return _mm512_mask_blend_ps(m, no, yes); }
inline unsigned bits(Mask m) { return _cvtmask16_u32(m); }
#elif defined(__AVX2__)
constexpr int kLanes = 8;  // NOLINT(misc-definitions-in-headers)
using Floats = __m256;
using Mask = __m256;

inline Floats broadcast(float a) { return _mm256_set1_ps(a); }
inline Floats load(const float* p) { return _mm256_loadu_ps(p); }
inline void store(float* p, Floats a) { _mm256_storeu_ps(p, a); }
inline Floats minimum(Floats a, Floats b) { return _mm256_min_ps(a, b); }
inline Floats maximum(Floats a, Floats b) { return _mm256_max_ps(a, b); }
inline Floats squareRoot(Floats a) { return _mm256_sqrt_ps(a); }
inline Mask less(Floats a, Floats b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
inline Mask both(Mask a, Mask b) { return _mm256_and_ps(a, b); }
inline Mask either(Mask a, Mask b) { return _mm256_or_ps(a, b); }
inline Mask without(Mask a, Mask b) { return _mm256_andnot_ps(b, a); }
inline Floats select(Mask m, Floats yes, Floats no) { return _mm256_blendv_ps(no, yes, m); }
inline unsigned bits(Mask m) { return static_cast<unsigned>(_mm256_movemask_ps(m)); }
#elif defined(__SSE2__)
constexpr int kLanes = 4;  // NOLINT(misc-definitions-in-headers)
using Floats = __m128;
using Mask = __m128;

inline Floats broadcast(float a) { return _mm_set1_ps(a); }
inline Floats load(const float* p) { return _mm_loadu_ps(p); }
inline void store(float* p, Floats a) { _mm_storeu_ps(p, a); }
inline Floats minimum(Floats a, Floats b) { return _mm_min_ps(a, b); }
inline Floats maximum(Floats a, Floats b) { return _mm_max_ps(a, b); }
inline Floats squareRoot(Floats a) { return _mm_sqrt_ps(a); }
inline Mask less(Floats a, Floats b) { return _mm_cmplt_ps(a, b); }
inline Mask both(Mask a, Mask b) { return _mm_and_ps(a, b); }
inline Mask either(Mask a, Mask b) { return _mm_or_ps(a, b); }
inline Mask without(Mask a, Mask b) { return _mm_andnot_ps(b, a); }
inline Floats select(Mask m, Floats yes, Floats no) {
  return _mm_or_ps(_mm_and_ps(m, yes), _mm_andnot_ps(m, no));
}
inline unsigned bits(Mask m) { return static_cast<unsigned>(_mm_movemask_ps(m)); }
#else
constexpr int kLanes = 4;  // NOLINT(misc-definitions-in-headers)
struct Floats {
  float lane[kLanes];
};
struct Mask {
  bool lane[kLanes];
};

template <class Result = Floats, class Operation>
inline Result eachLane(Operation operation) {
  Result result;
  for (int i = 0; i < kLanes; ++i) result.lane[i] = operation(i);
  return result;
}
inline Floats broadcast(float a) {
  return eachLane([&](int) { return a; });
}
inline Floats load(const float* p) {
  return eachLane([&](int i) { return p[i]; });
}
inline void store(float* p, Floats a) {
  for (int i = 0; i < kLanes; ++i) p[i] = a.lane[i];
}
inline Floats operator+(Floats a, Floats b) {
  return eachLane([&](int i) { return a.lane[i] + b.lane[i]; });
}
inline Floats operator-(Floats a, Floats b) {
  return eachLane([&](int i) { return a.lane[i] - b.lane[i]; });
}
inline Floats operator*(Floats a, Floats b) {
  return eachLane([&](int i) { return a.lane[i] * b.lane[i]; });
}
inline Floats minimum(Floats a, Floats b) {
  return eachLane([&](int i) { return a.lane[i] < b.lane[i] ? a.lane[i] : b.lane[i]; });
}
inline Floats maximum(Floats a, Floats b) {
  return eachLane([&](int i) { return a.lane[i] > b.lane[i] ? a.lane[i] : b.lane[i]; });
}
inline Floats squareRoot(Floats a) {
  return eachLane([&](int i) { return __builtin_sqrtf(a.lane[i]); });
}
inline Mask less(Floats a, Floats b) {
  return eachLane<Mask>([&](int i) { return a.lane[i] < b.lane[i]; });
}
inline Mask both(Mask a, Mask b) {
  return eachLane<Mask>([&](int i) { return a.lane[i] && b.lane[i]; });
}
inline Mask either(Mask a, Mask b) {
  return eachLane<Mask>([&](int i) { return a.lane[i] || b.lane[i]; });
}
inline Mask without(Mask a, Mask b) {
  return eachLane<Mask>([&](int i) { return a.lane[i] && !b.lane[i]; });
}
inline Floats select(Mask m, Floats yes, Floats no) {
  return eachLane([&](int i) { return m.lane[i] ? yes.lane[i] : no.lane[i]; });
}
inline unsigned bits(Mask m) {
  unsigned result = 0;
  for (int i = 0; i < kLanes; ++i) result |= m.lane[i] ? 1U << i : 0U;
  return result;
}
#endif

}  // namespace
}  // namespace galactic::bake
