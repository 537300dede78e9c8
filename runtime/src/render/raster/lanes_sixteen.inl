// Vectors of sixteen, for AVX-512: the operations of lanes_eight.inl, with the same names and, lane
// by lane, the same bits. Blocks of eight in pools and panes are read two at a time.
#include <cstddef>
#include <cstdint>

#include "support/gather_avx2.inl"

namespace galactic::render {
namespace {

using Lanes = float __attribute__((vector_size(64)));
using IntLanes = std::int32_t __attribute__((vector_size(64)));
using WordLanes = std::uint32_t __attribute__((vector_size(64)));
using ShortLanes = std::uint16_t __attribute__((vector_size(64)));

/// Width of the rows in pools and of what is stored in blocks.
constexpr std::uint32_t kWidth = 8;
/// Lanes of a vector, and how many blocks fill it; the second lies below the first.
constexpr std::uint32_t kLanes = 16;
constexpr std::uint32_t kBlocks = 2;
constexpr unsigned kAllLanes = 0xFFFF;
constexpr std::size_t kVectorBytes = 64;
constexpr std::size_t kGroupAlignment = 64;

/// Half as many numbers of twice the size fill a vector.
constexpr std::uint32_t kHalf = kLanes / 2;
using Doubles = double __attribute__((vector_size(64)));
using HalfInts = std::int32_t __attribute__((vector_size(32)));
using HalfFloats = float __attribute__((vector_size(32)));

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

/// The number of the lowest bit that is set. At least one must be.
inline int lowestBit(unsigned bits) { return __builtin_ctz(bits); }

/// A set of lanes.
using LaneSet = __mmask16;
inline unsigned bitsOf(LaneSet set) { return set; }
inline LaneSet eitherOf(LaneSet a, LaneSet b) { return _kor_mask16(a, b); }
inline LaneSet noLanes() { return 0; }
/// The lanes whose bits are set.
inline LaneSet setOf(unsigned bits) { return static_cast<LaneSet>(bits); }
inline LaneSet bySign(IntLanes v) { return _mm512_movepi32_mask(as<__m512i>(v)); }

inline IntLanes pickFrom(LaneSet set, IntLanes yes, IntLanes no) {
  return as<IntLanes>(_mm512_mask_blend_epi32(set, as<__m512i>(no), as<__m512i>(yes)));
}
inline Lanes pickFrom(LaneSet set, Lanes yes, Lanes no) {
  return as<Lanes>(_mm512_mask_blend_ps(set, as<__m512>(no), as<__m512>(yes)));
}

/// Writes the lanes of the set. Reading from there soon afterwards has to wait.
inline void storeFrom(LaneSet set, void* to, IntLanes v) {
  _mm512_mask_storeu_epi32(to, set, as<__m512i>(v));
}

inline LaneSet whereEqual(IntLanes a, IntLanes b) {
  return _mm512_cmpeq_epi32_mask(as<__m512i>(a), as<__m512i>(b));
}
inline LaneSet whereLess(Lanes a, Lanes b) {
  return _mm512_cmp_ps_mask(as<__m512>(a), as<__m512>(b), _CMP_LT_OQ);
}

/// The lanes whose sign is not set and where `a` is greater.
inline LaneSet insideAndGreater(IntLanes outside, Lanes a, Lanes b) {
  const LaneSet inside =
      _mm512_testn_epi32_mask(as<__m512i>(outside), _mm512_set1_epi32(INT32_MIN));
  return _mm512_mask_cmp_ps_mask(inside, as<__m512>(a), as<__m512>(b), _CMP_GT_OQ);
}

/// `mask`: all bits of a lane, or none.
inline IntLanes pick(IntLanes mask, IntLanes yes, IntLanes no) {
  return pickFrom(static_cast<LaneSet>(signBits(mask)), yes, no);
}
inline Lanes pick(IntLanes mask, Lanes yes, Lanes no) {
  return pickFrom(static_cast<LaneSet>(signBits(mask)), yes, no);
}

/// One lane, copied to all lanes.
inline IntLanes laneOf(IntLanes v, int lane) {
  return as<IntLanes>(_mm512_permutexvar_epi32(_mm512_set1_epi32(lane), as<__m512i>(v)));
}

/// Returns the second number if the comparison fails, as with NaN.
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

inline Doubles clampTo(Doubles v, double low, double high) {
  return as<Doubles>(
      _mm512_min_pd(_mm512_max_pd(as<__m512d>(v), _mm512_set1_pd(low)), _mm512_set1_pd(high)));
}

inline Lanes magnitude(Lanes v) { return as<Lanes>(as<IntLanes>(v) & 0x7FFFFFFF); }
inline float magnitude(float v) { return v < 0 ? -v : v; }
inline std::int32_t least(IntLanes v) { return _mm512_reduce_min_epi32(as<__m512i>(v)); }
inline std::int32_t most(IntLanes v) { return _mm512_reduce_max_epi32(as<__m512i>(v)); }
inline float least(Lanes v) { return _mm512_reduce_min_ps(as<__m512>(v)); }

/// Products and differences that may wrap around, in lanes whose result is not used.
inline IntLanes wrapMultiply(IntLanes a, IntLanes b) {
  return as<IntLanes>(as<WordLanes>(a) * as<WordLanes>(b));
}
inline IntLanes wrapSubtract(IntLanes a, IntLanes b) {
  return as<IntLanes>(as<WordLanes>(a) - as<WordLanes>(b));
}

/// Loads the block at `from` and the one `next` elements further.
inline IntLanes loadRows(const std::uint16_t* from, std::size_t next) {
  const auto low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
  const auto high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from + next));
  return as<IntLanes>(_mm512_cvtepu16_epi32(_mm256_set_m128i(high, low)));
}
inline IntLanes loadRows(const std::uint8_t* from, std::size_t next) {
  const auto low = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(from));
  const auto high = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(from + next));
  return as<IntLanes>(_mm512_cvtepu8_epi32(_mm_unpacklo_epi64(low, high)));
}
inline Lanes loadRows(const float* from, std::size_t next) {
  const __m512 low = _mm512_castps256_ps512(_mm256_loadu_ps(from));
  return as<Lanes>(_mm512_insertf32x8(low, _mm256_loadu_ps(from + next), 1));
}

/// Loads four numbers of each of four rows that lie `stride` numbers apart.
inline Lanes loadSquare(const float* from, std::size_t stride) {
  const __m256 upper = _mm256_set_m128(_mm_loadu_ps(from + stride), _mm_loadu_ps(from));
  from += 2 * stride;
  const __m256 lower = _mm256_set_m128(_mm_loadu_ps(from + stride), _mm_loadu_ps(from));
  return as<Lanes>(_mm512_insertf32x8(_mm512_castps256_ps512(upper), lower, 1));
}

inline __m256i lowHalf(IntLanes v) { return _mm512_castsi512_si256(as<__m512i>(v)); }
inline __m256i highHalf(IntLanes v) { return _mm512_extracti64x4_epi64(as<__m512i>(v), 1); }
template <class Vector>
inline Vector joined(__m256 low, __m256 high) {
  return as<Vector>(_mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1));
}

inline Lanes gather(const float* from, IntLanes at) {
  const auto eight = [from](__m256i half) {
    return _mm256_castsi256_ps(detail::gatherEight<sizeof(float)>(from, half));
  };
  return joined<Lanes>(eight(lowHalf(at)), eight(highHalf(at)));
}

inline IntLanes gather(const std::int32_t* from, IntLanes at) {
  return as<IntLanes>(gather(reinterpret_cast<const float*>(from), at));
}

/// Looks up entries of a table of 128 by their numbers. `stride`: from sixteen entries to the next
/// sixteen. During many look-ups the table stays in registers, so that no element is loaded
/// separately.
inline Lanes lookUp(const float* table, IntLanes at, std::size_t stride = kLanes) {
  const auto index = as<__m512i>(at);
  const auto of_32 = [&](std::size_t n) {
    return _mm512_permutex2var_ps(_mm512_load_ps(table + 2 * n * stride), index,
                                  _mm512_load_ps(table + (2 * n + 1) * stride));
  };
  const LaneSet odd = _mm512_test_epi32_mask(index, _mm512_set1_epi32(32));
  const LaneSet upper = _mm512_test_epi32_mask(index, _mm512_set1_epi32(64));
  const __m512 low = _mm512_mask_blend_ps(odd, of_32(0), of_32(1));
  const __m512 high = _mm512_mask_blend_ps(odd, of_32(2), of_32(3));
  return as<Lanes>(_mm512_mask_blend_ps(upper, low, high));
}
inline IntLanes lookUp(const std::int32_t* table, IntLanes at, std::size_t stride = kLanes) {
  return as<IntLanes>(lookUp(reinterpret_cast<const float*>(table), at, stride));
}

/// Looks up entries of a table of at most kFewEntries, aligned to a whole vector, by their numbers.
constexpr std::uint32_t kFewEntries = 32;
inline Lanes lookUpFew(const float* table, IntLanes at) {
  return as<Lanes>(_mm512_permutex2var_ps(_mm512_load_ps(table), as<__m512i>(at),
                                          _mm512_load_ps(table + kLanes)));
}

template <class Vector>
struct Pair {
  Vector first, second;
};

/// Elements at and at + 1. The gather instruction would read them one by one, too.
[[gnu::always_inline]] inline Pair<IntLanes> gatherNeighbors(const std::int32_t* from,
                                                             const IntLanes& at) {
  const auto two = [&](int lane) {
    const std::int32_t* first = from + static_cast<std::uint32_t>(at[lane]);
    const std::int32_t* second = from + static_cast<std::uint32_t>(at[lane + 1]);
    const __m128i low = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(first));
    return _mm_loadh_pi(_mm_castsi128_ps(low), reinterpret_cast<const __m64*>(second));
  };
  const auto eight = [&](int lane) {
    const __m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(two(lane)), two(lane + 4), 1);
    const __m256 high =
        _mm256_insertf128_ps(_mm256_castps128_ps256(two(lane + 8)), two(lane + 12), 1);
    return _mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
  };
  const __m512 even = eight(0);
  const __m512 odd = eight(2);
  return {as<IntLanes>(_mm512_shuffle_ps(even, odd, 0x88)),
          as<IntLanes>(_mm512_shuffle_ps(even, odd, 0xDD))};
}

/// Elements at or, in lanes where the mask `both` is set, the lesser of elements at and at + 1.
/// Both are always read.
inline Lanes gatherLeast(const float* from, IntLanes at, IntLanes both) {
  const auto* words = reinterpret_cast<const std::int32_t*>(from);
  const detail::TwoOfEight low = detail::gatherTwoOfEight<1>(words, lowHalf(at));
  const detail::TwoOfEight high = detail::gatherTwoOfEight<1>(words, highHalf(at));
  const auto first = joined<Lanes>(low.first, high.first);
  return lesser(first, pick(both, joined<Lanes>(low.second, high.second), first));
}

/// Looks up entries of a table of pairs, which has sixteen first numbers followed by their second
/// numbers.
template <class Element>
inline auto lookUpPairs(const Element* table, IntLanes at) {
  constexpr std::size_t kStride = std::size_t{2} * kLanes;
  return Pair<decltype(lookUp(table, at))>{lookUp(table, at, kStride),
                                           lookUp(table + kLanes, at, kStride)};
}
template <class Element>
inline Pair<Element> pairAt(const Element* table, std::uint32_t number) {
  const Element* first = table + std::size_t{2} * kLanes * (number / kLanes) + number % kLanes;
  return {first[0], first[kLanes]};
}
template <class Vector, class Element>
inline void storePairs(Element* to, Vector first, Vector second) {
  store(to, first);
  store(to + kLanes, second);
}

/// Transposes quarters: in each quarter, vector n gets number n of all four vectors, in their
/// order.
inline void transposeQuarters(const __m512* from, __m512* to) {
  const __m512 a = _mm512_unpacklo_ps(from[0], from[1]);
  const __m512 b = _mm512_unpackhi_ps(from[0], from[1]);
  const __m512 c = _mm512_unpacklo_ps(from[2], from[3]);
  const __m512 d = _mm512_unpackhi_ps(from[2], from[3]);
  to[0] = _mm512_shuffle_ps(a, c, 0x44);
  to[1] = _mm512_shuffle_ps(a, c, 0xEE);
  to[2] = _mm512_shuffle_ps(b, d, 0x44);
  to[3] = _mm512_shuffle_ps(b, d, 0xEE);
}

/// Reads eight numbers of the row that begins at number at[lane], for each lane, into a vector
/// each. Only the case that all lanes have the same row is treated separately, because the number
/// of different rows is hard to predict.
[[gnu::always_inline]] inline void gatherRows(const float* rows, const std::int32_t* at,
                                              Lanes* fields) {
  const auto row = [&](std::uint32_t lane) { return rows + static_cast<std::uint32_t>(at[lane]); };
  if (_mm512_cmpneq_epi32_mask(_mm512_load_si512(at), _mm512_set1_epi32(at[0])) == 0) {
    for (std::uint32_t n = 0; n < 8; ++n) fields[n] = spread(row(0)[n]);
    return;
  }
  __m512 quarters[8];
  for (std::uint32_t n = 0; n < 8; n += 4) {
    __m512 pairs[4];
    for (std::uint32_t k = 0; k < 4; ++k) {
      const __m512 first = _mm512_castps256_ps512(_mm256_load_ps(row(2 * n + k)));
      pairs[k] = _mm512_insertf32x8(first, _mm256_load_ps(row(2 * n + k + 4)), 1);
    }
    transposeQuarters(pairs, quarters + n);
  }
  for (std::uint32_t n = 0; n < 4; ++n) {
    fields[n] = as<Lanes>(_mm512_shuffle_f32x4(quarters[n], quarters[n + 4], 0x88));
    fields[n + 4] = as<Lanes>(_mm512_shuffle_f32x4(quarters[n], quarters[n + 4], 0xDD));
  }
}

/// Writes the lanes whose bits are set, in ascending order, and after them meaningless ones,
/// sixteen in all.
inline void storePicked(std::int32_t* to, IntLanes v, unsigned which) {
  store(to, as<IntLanes>(_mm512_maskz_compress_epi32(static_cast<LaneSet>(which), as<__m512i>(v))));
}

/// The values in the first pair of a column of blocks, where each block is a step further than the
/// one above. `begin` has the first block in both halves; if its row is odd, it is the lower one of
/// its pair.
inline Lanes firstBlocks(Lanes begin, Lanes step, std::int32_t row = 0) {
  const LaneSet lower = row % 2 != 0 ? 0 : 0xFF00;
  return as<Lanes>(
      _mm512_mask_add_ps(as<__m512>(begin), lower, as<__m512>(begin), as<__m512>(step)));
}
/// The values in the next pair of blocks.
inline Lanes nextBlocks(Lanes blocks, Lanes step) {
  const __m512 last = _mm512_shuffle_f32x4(as<__m512>(blocks), as<__m512>(blocks), 0xEE);
  return firstBlocks(as<Lanes>(_mm512_add_ps(last, as<__m512>(step))), step);
}

/// A number for each block.
inline Lanes ofBlocks(float first, float second) {
  return pickFrom(setOf(0xFF00), spread(second), spread(first));
}

/// Writes eight vectors, each with one number of sixteen rows, as rows of eight that lie `stride`
/// apart.
inline void storeTransposed(const Lanes* fields, float* to, std::size_t stride) {
  __m512 from[8];
  for (int n = 0; n < 8; ++n) from[n] = as<__m512>(fields[n]);
  __m512 quads[2][4];
  transposeQuarters(from, quads[0]);
  transposeQuarters(from + 4, quads[1]);
  const __m512i low_rows =
      _mm512_setr_epi32(0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23);
  const __m512i high_rows = _mm512_add_epi32(low_rows, _mm512_set1_epi32(8));
  for (std::size_t n = 0; n < 4; ++n) {
    const __m512 low = _mm512_permutex2var_ps(quads[0][n], low_rows, quads[1][n]);
    const __m512 high = _mm512_permutex2var_ps(quads[0][n], high_rows, quads[1][n]);
    _mm256_storeu_ps(to + n * stride, _mm512_castps512_ps256(low));
    _mm256_storeu_ps(to + (n + 4) * stride, _mm512_extractf32x8_ps(low, 1));
    _mm256_storeu_ps(to + (n + 8) * stride, _mm512_castps512_ps256(high));
    _mm256_storeu_ps(to + (n + 12) * stride, _mm512_extractf32x8_ps(high, 1));
  }
}

/// Writes four rows of pixels to an image whose rows lie `stride` bytes apart.
inline void storeBlocks(std::uint8_t* to, std::size_t stride, IntLanes v) {
  store(to, _mm512_castsi512_si128(as<__m512i>(v)));
  store(to + stride, _mm512_extracti32x4_epi32(as<__m512i>(v), 1));
  store(to + 2 * stride, _mm512_extracti32x4_epi32(as<__m512i>(v), 2));
  store(to + 3 * stride, _mm512_extracti32x4_epi32(as<__m512i>(v), 3));
}

/// The weight that blend() takes for a share within [0, 1], in both halves of a lane.
inline ShortLanes blendWeight(Lanes share) {
  // -128 times the weight, which is in 256ths.
  const IntLanes negative = toInt(share * spread(-256.0F) - spread(0.5F));
  return as<ShortLanes>((negative << 7 & 0xFFFF) | negative << 23);
}

/// p + (q - p) * weight / 256 for the 16-bit halves of all lanes, which hold bytes.
inline ShortLanes blend(ShortLanes p, ShortLanes q, ShortLanes weight) {
  // The instruction divides by 2^15 and rounds.
  return p + as<ShortLanes>(_mm512_mulhrs_epi16(as<__m512i>(p - q), as<__m512i>(weight)));
}

/// a * b / 255, rounded, for 16-bit halves that hold bytes.
inline ShortLanes byteProducts(ShortLanes a, ShortLanes b) {
  // (p + p / 256) / 256, both rounded down.
  return as<ShortLanes>(_mm512_mulhi_epu16(as<__m512i>(a * b + 128), _mm512_set1_epi16(257)));
}

/// Whole numbers in both types.
struct Whole {
  Lanes value;
  IntLanes whole;
};
/// Rounds down. Lanes must be below 2^22.
inline Whole roundedDown(Lanes v) {
  const auto floats = as<Lanes>(_mm512_floor_ps(as<__m512>(v)));
  return {floats, toInt(floats)};
}

}  // namespace
}  // namespace galactic::render
