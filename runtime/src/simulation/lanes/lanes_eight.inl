// Vectors of eight envs or spheres, in terms of which kernels are written, and their conversion to
// one row per env or sphere. No library templates here: see column_grid_avx2.cpp.
#if defined(__AVX2__)
#include <immintrin.h>

#include "support/gather_avx2.inl"
#endif

namespace galactic::simulation {
namespace {

constexpr std::size_t kWidth = 8;

using Lanes = float __attribute__((vector_size(32)));
using IntLanes = std::int32_t __attribute__((vector_size(32)));

inline Lanes load(const float* from) {
  Lanes lanes;
  __builtin_memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

inline void store(float* to, Lanes lanes) { __builtin_memcpy(to, &lanes, sizeof(lanes)); }

inline Lanes spread(float value) {
  return Lanes{value, value, value, value, value, value, value, value};
}

inline IntLanes loadInts(const std::int32_t* from) {
  IntLanes lanes;
  __builtin_memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

inline void storeInts(std::int32_t* to, IntLanes lanes) {
  __builtin_memcpy(to, &lanes, sizeof(lanes));
}

/// Sets all bits of the lanes whose bit is set in `bits`.
inline IntLanes lanesOf(unsigned bits) {
  const IntLanes each{1, 2, 4, 8, 16, 32, 64, 128};
  return (each & static_cast<std::int32_t>(bits)) != 0;
}

#if defined(__AVX2__)

/// The signs of lanes, as bits.
inline unsigned signsOf(IntLanes lanes) {
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(lanes)));
}

/// The nearest whole numbers, with ties to even, for |value| < 2^31.
inline IntLanes nearestWhole(Lanes value) {
  return reinterpret_cast<IntLanes>(_mm256_cvtps_epi32(reinterpret_cast<__m256>(value)));
}

/// Loads the words at `index` times kScale bytes after `from`; no index may be negative.
template <int kScale>
inline IntLanes gather(const void* from, const std::int32_t* index) {
  return reinterpret_cast<IntLanes>(detail::gatherEight<kScale>(from, detail::indicesAt(index)));
}

#else

inline unsigned signsOf(IntLanes lanes) {
  unsigned bits = 0;
  for (unsigned n = 0; n < kWidth; ++n) bits |= (lanes[n] < 0 ? 1U : 0U) << n;
  return bits;
}

inline IntLanes nearestWhole(Lanes value) {
  IntLanes whole{};
  for (unsigned n = 0; n < kWidth; ++n) {
    whole[n] = static_cast<std::int32_t>(__builtin_lrintf(value[n]));
  }
  return whole;
}

template <int kScale>
inline IntLanes gather(const void* from, const std::int32_t* index) {
  IntLanes words{};
  for (unsigned n = 0; n < kWidth; ++n) {
    std::int32_t word = 0;
    __builtin_memcpy(&word, static_cast<const char*>(from) + std::ptrdiff_t{index[n]} * kScale,
                     sizeof(word));
    words[n] = word;
  }
  return words;
}

#endif

/// The least of the eight numbers of each vector.
inline void leastOf(Lanes x, Lanes z, float& least_x, float& least_z) {
  const auto lesser = [](auto a, auto b) { return b < a ? b : a; };
  const Lanes pairs = lesser(__builtin_shufflevector(x, z, 0, 8, 1, 9, 4, 12, 5, 13),
                             __builtin_shufflevector(x, z, 2, 10, 3, 11, 6, 14, 7, 15));
  const auto both = lesser(__builtin_shufflevector(pairs, pairs, 0, 1, 2, 3),
                           __builtin_shufflevector(pairs, pairs, 4, 5, 6, 7));
  least_x = both[2] < both[0] ? both[2] : both[0];
  least_z = both[3] < both[1] ? both[3] : both[1];
}

/// The least and the greatest of eight numbers.
inline void spanOf(IntLanes lanes, std::int32_t& least, std::int32_t& most) {
  const auto lower = __builtin_shufflevector(lanes, lanes, 0, 1, 2, 3);
  const auto upper = __builtin_shufflevector(lanes, lanes, 4, 5, 6, 7);
  const auto less = upper < lower ? upper : lower;
  const auto more = upper > lower ? upper : lower;
  // Inverting the bits reverses the order.
  const auto one = __builtin_shufflevector(less, ~more, 0, 1, 4, 5);
  const auto other = __builtin_shufflevector(less, ~more, 2, 3, 6, 7);
  const auto both = other < one ? other : one;
  least = both[1] < both[0] ? both[1] : both[0];
  most = ~(both[3] < both[2] ? both[3] : both[2]);
}

/// Loads element 0 of eight rows.
inline Lanes loadStrided(const float* p, std::size_t stride) {
  return Lanes{p[0],          p[stride],     p[2 * stride], p[3 * stride],
               p[4 * stride], p[5 * stride], p[6 * stride], p[7 * stride]};
}

/// Four floats.
using Quarter = float __attribute__((vector_size(16)));

inline Quarter loadFour(const float* from) {
  Quarter four;
  __builtin_memcpy(&four, from, sizeof(four));
  return four;
}

/// The columns of four rows of eight: the four numbers of lane n, then those of lane n + 4.
inline void transposeFour(const Lanes rows[4], Lanes columns[4]) {
  const Lanes a = __builtin_shufflevector(rows[0], rows[1], 0, 8, 1, 9, 4, 12, 5, 13);
  const Lanes b = __builtin_shufflevector(rows[0], rows[1], 2, 10, 3, 11, 6, 14, 7, 15);
  const Lanes c = __builtin_shufflevector(rows[2], rows[3], 0, 8, 1, 9, 4, 12, 5, 13);
  const Lanes d = __builtin_shufflevector(rows[2], rows[3], 2, 10, 3, 11, 6, 14, 7, 15);
  columns[0] = __builtin_shufflevector(a, c, 0, 1, 8, 9, 4, 5, 12, 13);
  columns[1] = __builtin_shufflevector(a, c, 2, 3, 10, 11, 6, 7, 14, 15);
  columns[2] = __builtin_shufflevector(b, d, 0, 1, 8, 9, 4, 5, 12, 13);
  columns[3] = __builtin_shufflevector(b, d, 2, 3, 10, 11, 6, 7, 14, 15);
}

/// The opposite of storeColumns().
inline void loadColumns(const float* from, std::size_t stride, Lanes rows[8]) {
  for (std::size_t half = 0; half < 8; half += 4) {
    Lanes columns[4];
    for (std::size_t n = 0; n < 4; ++n) {
      const float* column = from + n * stride + half;
      columns[n] = __builtin_shufflevector(loadFour(column), loadFour(column + 4 * stride), 0, 1, 2,
                                           3, 4, 5, 6, 7);
    }
    transposeFour(columns, rows + half);
  }
}

/// Writes eight vectors as columns: lane n to `to` + n * stride. One half of the lanes after the
/// other, so that no register is spilled.
inline void storeColumns(const Lanes rows[8], float* to, std::size_t stride) {
  Lanes halves[4];
  Lanes columns[4];
  for (std::size_t n = 0; n < 4; ++n) {
    halves[n] = __builtin_shufflevector(rows[n], rows[n + 4], 0, 1, 2, 3, 8, 9, 10, 11);
  }
  transposeFour(halves, columns);
  for (std::size_t n = 0; n < 4; ++n) store(to + n * stride, columns[n]);
  for (std::size_t n = 0; n < 4; ++n) {
    halves[n] = __builtin_shufflevector(rows[n], rows[n + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
  transposeFour(halves, columns);
  for (std::size_t n = 0; n < 4; ++n) store(to + (n + 4) * stride, columns[n]);
}

/// The same for four vectors.
inline void storeFourColumns(const Lanes rows[4], float* to, std::size_t stride) {
  Lanes columns[4];
  transposeFour(rows, columns);
  constexpr std::size_t kHalf = 4 * sizeof(float);
  for (std::size_t n = 0; n < 4; ++n) {
    const auto* column = reinterpret_cast<const char*>(columns + n);
    __builtin_memcpy(to + stride * n, column, kHalf);
    __builtin_memcpy(to + stride * (n + 4), column + kHalf, kHalf);
  }
}

}  // namespace
}  // namespace galactic::simulation
