// Loads of eight elements by index; included by files that are compiled for AVX2. Loading them one
// by one is faster than the gather instructions where these are microcode, as on AMD processors
// (1.3 ns instead of 2.9 on Zen 5), or slowed down because of CVE-2022-40982, as on many Intel
// processors. No library templates here: see column_grid_avx2.cpp.
#include <immintrin.h>

namespace galactic::detail {
namespace {

/// Eight indices, 0 or greater, in four registers.
struct EightIndices {
  std::uint64_t pairs[4];

  [[nodiscard]] std::size_t even(int pair) const { return static_cast<std::uint32_t>(pairs[pair]); }
  [[nodiscard]] std::size_t odd(int pair) const { return pairs[pair] >> 32U; }
};

inline EightIndices indicesOf(__m256i lanes) {
  const __m128i low = _mm256_castsi256_si128(lanes);
  const __m128i high = _mm256_extracti128_si256(lanes, 1);
  return {{static_cast<std::uint64_t>(_mm_cvtsi128_si64(low)),
           static_cast<std::uint64_t>(_mm_extract_epi64(low, 1)),
           static_cast<std::uint64_t>(_mm_cvtsi128_si64(high)),
           static_cast<std::uint64_t>(_mm_extract_epi64(high, 1))}};
}

/// The same for indices that are already in memory.
inline EightIndices indicesAt(const std::int32_t* from) {
  EightIndices indices;
  __builtin_memcpy(&indices, from, sizeof(indices));
  return indices;
}

/// The 32-bit words that begin kScale * n bytes after `from`, one for each index n.
template <int kScale>
inline __m256i gatherEight(const void* from, const EightIndices& at) {
  const auto word = [from](std::size_t n) {
    std::int32_t value = 0;
    __builtin_memcpy(&value, static_cast<const char*>(from) + n * kScale, sizeof(value));
    return value;
  };
  return _mm256_setr_epi32(word(at.even(0)), word(at.odd(0)), word(at.even(1)), word(at.odd(1)),
                           word(at.even(2)), word(at.odd(2)), word(at.even(3)), word(at.odd(3)));
}

template <int kScale>
inline __m256i gatherEight(const void* from, __m256i at) {
  return gatherEight<kScale>(from, indicesOf(at));
}

struct TwoOfEight {
  __m256 first, second;
};

/// Elements kStride * at and the ones after them.
template <std::size_t kStride>
inline TwoOfEight gatherTwoOfEight(const std::int32_t* from, __m256i at) {
  const EightIndices n = indicesOf(at);
  const auto two = [&](int pair) {
    const std::int32_t* first = from + kStride * n.even(pair);
    const std::int32_t* second = from + kStride * n.odd(pair);
    const __m128i low = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(first));
    return _mm_loadh_pi(_mm_castsi128_ps(low), reinterpret_cast<const __m64*>(second));
  };
  const __m256 low = _mm256_set_m128(two(2), two(0));
  const __m256 high = _mm256_set_m128(two(3), two(1));
  return {_mm256_shuffle_ps(low, high, 0x88), _mm256_shuffle_ps(low, high, 0xDD)};
}

}  // namespace
}  // namespace galactic::detail
