// Vectors of sixteen, for AVX-512: of the operations of lanes_eight.inl those that resolving a pane
// is made of. The same names and, lane by lane, the same bits.
#include "render/raster/gather_avx2.inl"

namespace galactic::render {
namespace {

using Lanes = float __attribute__((vector_size(64)));
using IntLanes = std::int32_t __attribute__((vector_size(64)));
using WordLanes = std::uint32_t __attribute__((vector_size(64)));
using ShortLanes = std::uint16_t __attribute__((vector_size(64)));

/// Of what is stored in blocks.
constexpr std::uint32_t kWidth = 8;
/// Of vectors.
constexpr std::uint32_t kLanes = 16;
constexpr unsigned kAllLanes = 0xFFFF;
constexpr std::size_t kVectorBytes = 64;

/// The same bits as another type.
template <class To, class From>
inline To as(From from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  __builtin_memcpy(&to, &from, sizeof(to));
  return to;
}

template <class Vector>
inline Vector load(const void* from) {
  Vector lanes;
  __builtin_memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

template <class Vector>
inline void store(void* to, Vector lanes) {
  __builtin_memcpy(to, &lanes, sizeof(lanes));
}

inline Lanes spread(float v) { return as<Lanes>(_mm512_set1_ps(v)); }
inline IntLanes spread(std::int32_t v) { return as<IntLanes>(_mm512_set1_epi32(v)); }

inline Lanes toFloat(IntLanes v) { return __builtin_convertvector(v, Lanes); }
/// Towards 0; the values lie within the range of integers.
inline IntLanes toInt(Lanes v) { return __builtin_convertvector(v, IntLanes); }

/// Bit n: the sign of lane n.
inline unsigned signBits(IntLanes v) { return _mm512_movepi32_mask(as<__m512i>(v)); }

/// Of bits that are not all 0: the number of the lowest one.
inline int lowestBit(unsigned bits) { return __builtin_ctz(bits); }

/// `mask`: all bits of a lane, or none.
inline IntLanes pick(IntLanes mask, IntLanes yes, IntLanes no) {
  return as<IntLanes>(_mm512_mask_blend_epi32(static_cast<__mmask16>(signBits(mask)),
                                              as<__m512i>(no), as<__m512i>(yes)));
}

/// One lane, in all.
inline IntLanes laneOf(IntLanes v, int lane) {
  return as<IntLanes>(_mm512_permutexvar_epi32(_mm512_set1_epi32(lane), as<__m512i>(v)));
}

/// The second where the comparison fails, as with numbers that are none.
inline Lanes lesser(Lanes a, Lanes b) {
  return as<Lanes>(_mm512_min_ps(as<__m512>(a), as<__m512>(b)));
}
inline Lanes greater(Lanes a, Lanes b) {
  return as<Lanes>(_mm512_max_ps(as<__m512>(a), as<__m512>(b)));
}
inline IntLanes lesser(IntLanes a, IntLanes b) {
  return as<IntLanes>(_mm512_min_epi32(as<__m512i>(a), as<__m512i>(b)));
}
inline IntLanes greater(IntLanes a, IntLanes b) {
  return as<IntLanes>(_mm512_max_epi32(as<__m512i>(a), as<__m512i>(b)));
}

inline Lanes clampTo(Lanes v, float low, float high) {
  return lesser(greater(v, spread(low)), spread(high));
}

inline __m256i lowHalf(IntLanes v) { return _mm512_castsi512_si256(as<__m512i>(v)); }
inline __m256i highHalf(IntLanes v) { return _mm512_extracti64x4_epi64(as<__m512i>(v), 1); }
template <class Vector>
inline Vector joined(__m256 low, __m256 high) {
  return as<Vector>(_mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1));
}

inline IntLanes gather(const std::int32_t* from, IntLanes at) {
  const auto* floats = reinterpret_cast<const float*>(from);
  return joined<IntLanes>(gatherEight(floats, lowHalf(at)), gatherEight(floats, highHalf(at)));
}

template <class Vector>
struct Pair {
  Vector first, second;
};

/// Elements at and at + 1.
inline Pair<IntLanes> gatherNeighbors(const std::int32_t* from, IntLanes at) {
  const TwoOfEight low = gatherTwoOfEight<1>(from, lowHalf(at));
  const TwoOfEight high = gatherTwoOfEight<1>(from, highHalf(at));
  return {joined<IntLanes>(low.first, high.first), joined<IntLanes>(low.second, high.second)};
}

/// Elements kStride * ids[lane] and the three behind them become a vector each.
template <std::uint32_t kStride>
inline void gatherFour(const float* from, const std::int32_t* ids, Lanes* fields) {
  const auto four = [&](int n) {
    return _mm_loadu_ps(from + std::size_t{kStride} * static_cast<std::uint32_t>(ids[n]));
  };
  __m512 rows[4];
  for (int n = 0; n < 4; ++n) {
    const __m256 low = _mm256_set_m128(four(n + 4), four(n));
    const __m256 high = _mm256_set_m128(four(n + 12), four(n + 8));
    rows[n] = _mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
  }
  const __m512 a = _mm512_unpacklo_ps(rows[0], rows[1]);
  const __m512 b = _mm512_unpackhi_ps(rows[0], rows[1]);
  const __m512 c = _mm512_unpacklo_ps(rows[2], rows[3]);
  const __m512 d = _mm512_unpackhi_ps(rows[2], rows[3]);
  fields[0] = as<Lanes>(_mm512_shuffle_ps(a, c, 0x44));
  fields[1] = as<Lanes>(_mm512_shuffle_ps(a, c, 0xEE));
  fields[2] = as<Lanes>(_mm512_shuffle_ps(b, d, 0x44));
  fields[3] = as<Lanes>(_mm512_shuffle_ps(b, d, 0xEE));
}

/// p + (q - p) * weight / 256 for the 16-bit halves of all lanes, which are bytes; `rest` is 256
/// less the weight, and both are alike in the two halves of a lane.
inline ShortLanes blend(ShortLanes p, ShortLanes q, ShortLanes weight, ShortLanes rest) {
  return (p * rest + q * weight + 128) >> 8;
}

}  // namespace
}  // namespace galactic::render
