// Vectors of eight: the few operations that the kernels are made of. They use the compilers' vector
// extensions and, where compilers do not find the right instruction of AVX2, its intrinsic. Both
// give the same bits.
#include <cstddef>
#include <cstdint>

#if defined(__AVX2__)
#include "support/gather_avx2.inl"
#endif

namespace galactic::render {
namespace {

using Lanes = float __attribute__((vector_size(32)));
using IntLanes = std::int32_t __attribute__((vector_size(32)));
using WordLanes = std::uint32_t __attribute__((vector_size(32)));
using ShortLanes = std::uint16_t __attribute__((vector_size(32)));
using EightBytes = std::uint8_t __attribute__((vector_size(8)));
using EightShorts = std::uint16_t __attribute__((vector_size(16)));
/// A set of lanes: those whose sign is set.
using LaneSet = IntLanes;

/// Width of the rows in pools and of what is stored in blocks.
constexpr std::uint32_t kWidth = 8;
/// Lanes of a vector, and how many blocks fill it.
constexpr std::uint32_t kLanes = 8;
constexpr std::uint32_t kBlocks = 1;
constexpr unsigned kAllLanes = 0xFF;
constexpr std::size_t kVectorBytes = 32;
constexpr std::size_t kGroupAlignment = 64;

/// Half as many numbers of twice the size fill a vector.
constexpr std::uint32_t kHalf = kLanes / 2;
using Doubles = double __attribute__((vector_size(32)));
using HalfInts = std::int32_t __attribute__((vector_size(16)));
using HalfFloats = float __attribute__((vector_size(16)));

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

inline Lanes spread(float v) { return Lanes{v, v, v, v, v, v, v, v}; }
inline IntLanes spread(std::int32_t v) { return IntLanes{v, v, v, v, v, v, v, v}; }

inline Lanes toFloat(IntLanes v) { return __builtin_convertvector(v, Lanes); }
/// Towards 0; the values lie within the range of integers.
inline IntLanes toInt(Lanes v) { return __builtin_convertvector(v, IntLanes); }

/// `mask`: all bits of a lane, or none.
inline IntLanes pick(IntLanes mask, IntLanes yes, IntLanes no) {
#if defined(__AVX2__)
  return as<IntLanes>(_mm256_blendv_epi8(as<__m256i>(no), as<__m256i>(yes), as<__m256i>(mask)));
#else
  return (yes & mask) | (no & ~mask);
#endif
}

inline Lanes pick(IntLanes mask, Lanes yes, Lanes no) {
#if defined(__AVX2__)
  return as<Lanes>(_mm256_blendv_ps(as<__m256>(no), as<__m256>(yes), as<__m256>(mask)));
#else
  return as<Lanes>(pick(mask, as<IntLanes>(yes), as<IntLanes>(no)));
#endif
}

/// One lane, copied to all lanes.
inline IntLanes laneOf(IntLanes v, int lane) {
#if defined(__AVX2__)
  return as<IntLanes>(_mm256_permutevar8x32_epi32(as<__m256i>(v), as<__m256i>(spread(lane))));
#else
  return spread(v[lane]);
#endif
}

/// Returns the second number if the comparison fails, as with NaN.
inline Lanes lesser(Lanes a, Lanes b) {
#if defined(__AVX2__)
  return as<Lanes>(_mm256_min_ps(as<__m256>(a), as<__m256>(b)));
#else
  return pick(a < b, a, b);
#endif
}

inline Lanes greater(Lanes a, Lanes b) {
#if defined(__AVX2__)
  return as<Lanes>(_mm256_max_ps(as<__m256>(a), as<__m256>(b)));
#else
  return pick(a > b, a, b);
#endif
}

inline IntLanes lesser(IntLanes a, IntLanes b) {
#if defined(__AVX2__)
  return as<IntLanes>(_mm256_min_epi32(as<__m256i>(a), as<__m256i>(b)));
#else
  return pick(a < b, a, b);
#endif
}

inline IntLanes greater(IntLanes a, IntLanes b) {
#if defined(__AVX2__)
  return as<IntLanes>(_mm256_max_epi32(as<__m256i>(a), as<__m256i>(b)));
#else
  return pick(a > b, a, b);
#endif
}

inline Lanes clampTo(Lanes v, float low, float high) {
  return lesser(greater(v, spread(low)), spread(high));
}

inline Doubles clampTo(Doubles v, double low, double high) {
#if defined(__AVX2__)
  return as<Doubles>(
      _mm256_min_pd(_mm256_max_pd(as<__m256d>(v), _mm256_set1_pd(low)), _mm256_set1_pd(high)));
#else
  for (std::uint32_t n = 0; n < kHalf; ++n) v[n] = v[n] < low ? low : v[n] > high ? high : v[n];
  return v;
#endif
}

inline Lanes magnitude(Lanes v) { return as<Lanes>(as<IntLanes>(v) & 0x7FFFFFFF); }
inline float magnitude(float v) { return v < 0 ? -v : v; }

/// Bit n: the sign of lane n.
inline unsigned signBits(IntLanes v) {
#if defined(__AVX2__)
  return static_cast<unsigned>(_mm256_movemask_ps(as<__m256>(v)));
#else
  unsigned bits = 0;
  for (unsigned n = 0; n < kWidth; ++n) bits |= (static_cast<unsigned>(v[n]) >> 31U) << n;
  return bits;
#endif
}

inline unsigned bitsOf(LaneSet set) { return signBits(set); }
inline LaneSet eitherOf(LaneSet a, LaneSet b) { return a | b; }
inline LaneSet noLanes() { return spread(0); }
/// The lanes whose bits are set.
inline LaneSet setOf(unsigned bits) {
  const IntLanes to_sign{31, 30, 29, 28, 27, 26, 25, 24};
  return spread(static_cast<std::int32_t>(bits)) << to_sign;
}
inline LaneSet bySign(IntLanes v) { return v; }

inline LaneSet whereEqual(IntLanes a, IntLanes b) { return a == b; }
inline LaneSet whereLess(Lanes a, Lanes b) { return a < b; }

/// The lanes whose sign is not set and where `a` is greater.
inline LaneSet insideAndGreater(IntLanes outside, Lanes a, Lanes b) { return ~outside & (a > b); }

inline Lanes pickFrom(LaneSet set, Lanes yes, Lanes no) {
#if defined(__AVX2__)
  return pick(set, yes, no);
#else
  return pick(set >> 31, yes, no);
#endif
}
inline IntLanes pickFrom(LaneSet set, IntLanes yes, IntLanes no) {
  return as<IntLanes>(pickFrom(set, as<Lanes>(yes), as<Lanes>(no)));
}

/// Writes the lanes of the set.
inline void storeFrom(LaneSet set, void* to, IntLanes v) {
  store(to, pickFrom(set, v, load<IntLanes>(to)));
}

/// The number of the lowest bit that is set. At least one must be.
inline int lowestBit(unsigned bits) { return __builtin_ctz(bits); }

/// Products and differences that may wrap around, in lanes whose result is not used.
inline IntLanes wrapMultiply(IntLanes a, IntLanes b) {
  return as<IntLanes>(as<WordLanes>(a) * as<WordLanes>(b));
}
inline IntLanes wrapSubtract(IntLanes a, IntLanes b) {
  return as<IntLanes>(as<WordLanes>(a) - as<WordLanes>(b));
}

inline Lanes gather(const float* from, IntLanes at) {
#if defined(__AVX2__)
  return as<Lanes>(detail::gatherEight<sizeof(float)>(from, as<__m256i>(at)));
#else
  Lanes lanes;
  for (unsigned n = 0; n < kWidth; ++n) lanes[n] = from[at[n]];
  return lanes;
#endif
}

inline IntLanes gather(const std::int32_t* from, IntLanes at) {
  return as<IntLanes>(gather(reinterpret_cast<const float*>(from), at));
}

/// Looks up entries of a table by their numbers.
template <class Element>
inline auto lookUp(const Element* table, IntLanes at) {
  return gather(table, at);
}

/// Small tables lie in memory too, so none has entries that are cheaper to look up.
constexpr std::uint32_t kFewEntries = 0;
inline Lanes lookUpFew(const float* table, IntLanes at) { return lookUp(table, at); }

template <class Vector>
struct Pair {
  Vector first, second;
};

/// Elements kStride * at and kStride * at + 1.
template <int kStride>
inline Pair<IntLanes> gatherTwo(const std::int32_t* from, IntLanes at) {
#if defined(__AVX2__)
  const detail::TwoOfEight two = detail::gatherTwoOfEight<kStride>(from, as<__m256i>(at));
  return {as<IntLanes>(two.first), as<IntLanes>(two.second)};
#else
  Pair<IntLanes> result;
  for (unsigned n = 0; n < kWidth; ++n) {
    const std::int32_t* both = from + std::ptrdiff_t{kStride} * at[n];
    result.first[n] = both[0];
    result.second[n] = both[1];
  }
  return result;
#endif
}

/// Elements at and at + 1.
inline Pair<IntLanes> gatherNeighbors(const std::int32_t* from, const IntLanes& at) {
#if defined(__AVX2__)
  const auto two = [&](int lane) {
    const std::int32_t* first = from + static_cast<std::uint32_t>(at[lane]);
    const std::int32_t* second = from + static_cast<std::uint32_t>(at[lane + 1]);
    const __m128i low = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(first));
    return _mm_loadh_pi(_mm_castsi128_ps(low), reinterpret_cast<const __m64*>(second));
  };
  const __m256 even = _mm256_set_m128(two(4), two(0));
  const __m256 odd = _mm256_set_m128(two(6), two(2));
  return {as<IntLanes>(_mm256_shuffle_ps(even, odd, 0x88)),
          as<IntLanes>(_mm256_shuffle_ps(even, odd, 0xDD))};
#else
  return gatherTwo<1>(from, at);
#endif
}

/// Elements at or, in lanes where the mask `both` is set, the lesser of elements at and at + 1.
/// Both are always read.
inline Lanes gatherLeast(const float* from, IntLanes at, IntLanes both) {
  const Pair<IntLanes> two = gatherTwo<1>(reinterpret_cast<const std::int32_t*>(from), at);
  const auto first = as<Lanes>(two.first);
  return lesser(first, pick(both, as<Lanes>(two.second), first));
}

/// Looks up entries of a table of pairs by their numbers.
inline Pair<IntLanes> lookUpPairs(const std::int32_t* table, IntLanes at) {
  return gatherTwo<2>(table, at);
}
inline Pair<Lanes> lookUpPairs(const float* table, IntLanes at) {
  const Pair<IntLanes> bits = lookUpPairs(reinterpret_cast<const std::int32_t*>(table), at);
  return {as<Lanes>(bits.first), as<Lanes>(bits.second)};
}
template <class Element>
inline Pair<Element> pairAt(const Element* table, std::uint32_t number) {
  return {table[std::size_t{2} * number], table[std::size_t{2} * number + 1]};
}

using Quad = float __attribute__((vector_size(16)));

/// Reads elements at[lane] to at[lane] + 3 of each lane into a vector each.
inline void gatherFour(const float* from, const std::int32_t* at, Lanes* fields) {
  Lanes pairs[4];
  for (int n = 0; n < 4; ++n) {
    const auto near = load<Quad>(from + static_cast<std::uint32_t>(at[n]));
    const auto far = load<Quad>(from + static_cast<std::uint32_t>(at[n + 4]));
    pairs[n] = __builtin_shufflevector(near, far, 0, 1, 2, 3, 4, 5, 6, 7);
  }
  const Lanes a = __builtin_shufflevector(pairs[0], pairs[1], 0, 8, 1, 9, 4, 12, 5, 13);
  const Lanes b = __builtin_shufflevector(pairs[0], pairs[1], 2, 10, 3, 11, 6, 14, 7, 15);
  const Lanes c = __builtin_shufflevector(pairs[2], pairs[3], 0, 8, 1, 9, 4, 12, 5, 13);
  const Lanes d = __builtin_shufflevector(pairs[2], pairs[3], 2, 10, 3, 11, 6, 14, 7, 15);
  fields[0] = __builtin_shufflevector(a, c, 0, 1, 8, 9, 4, 5, 12, 13);
  fields[1] = __builtin_shufflevector(a, c, 2, 3, 10, 11, 6, 7, 14, 15);
  fields[2] = __builtin_shufflevector(b, d, 0, 1, 8, 9, 4, 5, 12, 13);
  fields[3] = __builtin_shufflevector(b, d, 2, 3, 10, 11, 6, 7, 14, 15);
}

/// Reads eight numbers of the row that begins at number at[lane], for each lane, into a vector
/// each. Often all lanes have the same row.
[[gnu::always_inline]] inline void gatherRows(const float* rows, const std::int32_t* at,
                                              Lanes* fields) {
  if (signBits(load<IntLanes>(at) == spread(at[0])) == kAllLanes) {
    const float* row = rows + static_cast<std::uint32_t>(at[0]);
    for (std::uint32_t n = 0; n < 8; ++n) fields[n] = spread(row[n]);
    return;
  }
  gatherFour(rows, at, fields);
  gatherFour(rows + 4, at, fields + 4);
}

/// Writes entries of a table of pairs.
template <class Vector, class Element>
inline void storePairs(Element* to, Vector first, Vector second) {
  store(to, __builtin_shufflevector(first, second, 0, 8, 1, 9, 2, 10, 3, 11));
  store(to + kWidth, __builtin_shufflevector(first, second, 4, 12, 5, 13, 6, 14, 7, 15));
}

/// Writes two rows of pixels to an image whose rows lie `stride` bytes apart.
inline void storeBlocks(std::uint8_t* to, std::size_t stride, IntLanes v) {
  store(to, __builtin_shufflevector(v, v, 0, 1, 2, 3));
  store(to + stride, __builtin_shufflevector(v, v, 4, 5, 6, 7));
}

/// The weight that blend() takes for a share within [0, 1], in both halves of a lane.
inline ShortLanes blendWeight(Lanes share) {
#if defined(__AVX2__)
  // -128 times the weight, which is in 256ths.
  const IntLanes negative = toInt(share * spread(-256.0F) - spread(0.5F));
  return as<ShortLanes>((negative << 7 & 0xFFFF) | negative << 23);
#else
  const IntLanes weight = toInt(share * spread(256.0F) + spread(0.5F));
  return as<ShortLanes>(weight | weight << 16);
#endif
}

/// p + (q - p) * weight / 256 for the 16-bit halves of all lanes, which hold bytes.
inline ShortLanes blend(ShortLanes p, ShortLanes q, ShortLanes weight) {
#if defined(__AVX2__)
  // The instruction divides by 2^15 and rounds.
  return p + as<ShortLanes>(_mm256_mulhrs_epi16(as<__m256i>(p - q), as<__m256i>(weight)));
#else
  return (p * (256 - weight) + q * weight + 128) >> 8;
#endif
}

/// a * b / 255, rounded, for 16-bit halves that hold bytes.
inline ShortLanes byteProducts(ShortLanes a, ShortLanes b) {
  const ShortLanes product = a * b + 128;
#if defined(__AVX2__)
  // (p + p / 256) / 256, both rounded down.
  return as<ShortLanes>(_mm256_mulhi_epu16(as<__m256i>(product), _mm256_set1_epi16(257)));
#else
  return (product + (product >> 8)) >> 8;
#endif
}

/// Whole numbers in both types.
struct Whole {
  Lanes value;
  IntLanes whole;
};
/// Rounds down. Lanes must be below 2^22.
inline Whole roundedDown(Lanes v) {
#if defined(__AVX2__)
  const auto floats = as<Lanes>(_mm256_floor_ps(as<__m256>(v)));
  return {floats, toInt(floats)};
#else
  const IntLanes towards_0 = toInt(v);
  const IntLanes whole = towards_0 + (toFloat(towards_0) > v);
  return {toFloat(whole), whole};
#endif
}

/// For each set of lanes, their numbers in ascending order, followed by lane 0.
struct PickOrders {
  alignas(64) std::uint8_t order[256][kWidth] = {};
  constexpr PickOrders() {
    for (unsigned which = 0; which < 256; ++which) {
      unsigned count = 0;
      for (unsigned n = 0; n < kWidth; ++n) {
        if ((which >> n & 1U) != 0) order[which][count++] = static_cast<std::uint8_t>(n);
      }
    }
  }
};
constexpr PickOrders kPickOrders;

inline IntLanes widen(EightShorts v) { return __builtin_convertvector(v, IntLanes); }
inline IntLanes widen(EightBytes v) {
#if defined(__AVX2__)
  return as<IntLanes>(_mm256_cvtepu8_epi32(_mm_cvtsi64_si128(as<long long>(v))));
#else
  return __builtin_convertvector(v, IntLanes);
#endif
}

/// Loads a block of eight. `next` is for wider vectors: where their second block lies.
inline IntLanes loadRows(const std::uint16_t* from, std::size_t /*next*/) {
  return widen(load<EightShorts>(from));
}
inline IntLanes loadRows(const std::uint8_t* from, std::size_t /*next*/) {
  return widen(load<EightBytes>(from));
}
inline Lanes loadRows(const float* from, std::size_t /*next*/) { return load<Lanes>(from); }

/// Loads four numbers of each of two rows that lie `stride` numbers apart.
inline Lanes loadSquare(const float* from, std::size_t stride) {
  return __builtin_shufflevector(load<Quad>(from), load<Quad>(from + stride), 0, 1, 2, 3, 4, 5, 6,
                                 7);
}

/// Writes the lanes whose bits are set, in ascending order, and after them meaningless ones, eight
/// in all. Takes the same time for any set, since nothing depends on its size.
inline void storePicked(std::int32_t* to, IntLanes v, unsigned which) {
  const IntLanes order = widen(load<EightBytes>(kPickOrders.order[which]));
#if defined(__AVX2__)
  store(to, as<IntLanes>(_mm256_permutevar8x32_epi32(as<__m256i>(v), as<__m256i>(order))));
#else
  for (unsigned n = 0; n < kWidth; ++n) to[n] = v[order[n]];
#endif
}

/// The value in the first block of a column of blocks, where each block is a step further than the
/// one above.
inline Lanes firstBlocks(Lanes begin, Lanes /*step*/, std::int32_t /*row*/ = 0) { return begin; }
/// The value in the next block.
inline Lanes nextBlocks(Lanes blocks, Lanes step) { return blocks + step; }
/// A number for each block.
inline Lanes ofBlocks(float first, float /*second*/) { return spread(first); }

/// Writes eight vectors, each with one number of eight rows, as rows that lie `stride` apart.
inline void storeTransposed(const Lanes* fields, float* to, std::size_t stride) {
  Lanes a[kWidth];
  for (std::uint32_t n = 0; n < kWidth; n += 2) {
    a[n] = __builtin_shufflevector(fields[n], fields[n + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    a[n + 1] = __builtin_shufflevector(fields[n], fields[n + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  Lanes b[kWidth];
  for (std::uint32_t n = 0; n < kWidth; n += 4) {
    b[n] = __builtin_shufflevector(a[n], a[n + 2], 0, 1, 8, 9, 4, 5, 12, 13);
    b[n + 1] = __builtin_shufflevector(a[n], a[n + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    b[n + 2] = __builtin_shufflevector(a[n + 1], a[n + 3], 0, 1, 8, 9, 4, 5, 12, 13);
    b[n + 3] = __builtin_shufflevector(a[n + 1], a[n + 3], 2, 3, 10, 11, 6, 7, 14, 15);
  }
  for (std::uint32_t n = 0; n < 4; ++n) {
    store(to + n * stride, __builtin_shufflevector(b[n], b[n + 4], 0, 1, 2, 3, 8, 9, 10, 11));
    store(to + (n + 4) * stride,
          __builtin_shufflevector(b[n], b[n + 4], 4, 5, 6, 7, 12, 13, 14, 15));
  }
}

template <class Vector>
inline auto least(Vector v) {
  v = lesser(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3));
  v = lesser(v, __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5));
  v = lesser(v, __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6));
  return v[0];
}
inline std::int32_t most(IntLanes v) { return -least(-v); }

}  // namespace
}  // namespace galactic::render
