// Like lanes_eight.inl for vectors of sixteen envs, with only what the motion kernels need.
namespace galactic::simulation {
namespace {

constexpr std::size_t kWidth = 16;

using Lanes = float __attribute__((vector_size(64)));
using IntLanes = std::int32_t __attribute__((vector_size(64)));

inline Lanes load(const float* from) {
  Lanes lanes;
  __builtin_memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

/// Stores all lanes, or a part of them.
template <class Part>
inline void store(float* to, Part lanes) {
  __builtin_memcpy(to, &lanes, sizeof(lanes));
}

inline Lanes spread(float value) {
  return Lanes{value, value, value, value, value, value, value, value,
               value, value, value, value, value, value, value, value};
}

/// Loads element 0 of sixteen rows.
inline Lanes loadStrided(const float* p, std::size_t stride) {
  const float* q = p + 8 * stride;
  return Lanes{p[0],          p[stride],     p[2 * stride], p[3 * stride],
               p[4 * stride], p[5 * stride], p[6 * stride], p[7 * stride],
               q[0],          q[stride],     q[2 * stride], q[3 * stride],
               q[4 * stride], q[5 * stride], q[6 * stride], q[7 * stride]};
}

/// Four and eight floats.
using Quarter = float __attribute__((vector_size(16)));
using Half = float __attribute__((vector_size(32)));

inline Quarter loadFour(const float* from) {
  Quarter four;
  __builtin_memcpy(&four, from, sizeof(four));
  return four;
}

/// Loads four floats from each of two columns.
inline Half loadTwoFours(const float* from, std::size_t columns) {
  return __builtin_shufflevector(loadFour(from), loadFour(from + columns), 0, 1, 2, 3, 4, 5, 6, 7);
}

/// The columns of four rows of sixteen: the numbers of lanes n, n + 4, n + 8 and n + 12.
inline void transposeFour(const Lanes rows[4], Lanes columns[4]) {
  const Lanes a = __builtin_shufflevector(rows[0], rows[1], 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9,
                                          25, 12, 28, 13, 29);
  const Lanes b = __builtin_shufflevector(rows[0], rows[1], 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11,
                                          27, 14, 30, 15, 31);
  const Lanes c = __builtin_shufflevector(rows[2], rows[3], 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9,
                                          25, 12, 28, 13, 29);
  const Lanes d = __builtin_shufflevector(rows[2], rows[3], 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11,
                                          27, 14, 30, 15, 31);
  columns[0] =
      __builtin_shufflevector(a, c, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
  columns[1] =
      __builtin_shufflevector(a, c, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
  columns[2] =
      __builtin_shufflevector(b, d, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
  columns[3] =
      __builtin_shufflevector(b, d, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
}

/// The opposite of storeColumns().
inline void loadColumns(const float* from, std::size_t stride, Lanes rows[8]) {
  for (std::size_t half = 0; half < 8; half += 4) {
    Lanes columns[4];
    for (std::size_t n = 0; n < 4; ++n) {
      const float* column = from + n * stride + half;
      columns[n] = __builtin_shufflevector(loadTwoFours(column, 4 * stride),
                                           loadTwoFours(column + 8 * stride, 4 * stride), 0, 1, 2,
                                           3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    }
    transposeFour(columns, rows + half);
  }
}

/// Writes eight vectors as columns: lane n to `to` + n * stride.
inline void storeColumns(const Lanes rows[8], float* to, std::size_t stride) {
  Lanes first[4];
  Lanes last[4];
  transposeFour(rows, first);
  transposeFour(rows + 4, last);
  for (std::size_t n = 0; n < 4; ++n) {
    const Lanes lower = __builtin_shufflevector(first[n], last[n], 0, 1, 2, 3, 16, 17, 18, 19, 4, 5,
                                                6, 7, 20, 21, 22, 23);
    const Lanes upper = __builtin_shufflevector(first[n], last[n], 8, 9, 10, 11, 24, 25, 26, 27, 12,
                                                13, 14, 15, 28, 29, 30, 31);
    float* column = to + n * stride;
    store(column, __builtin_shufflevector(lower, lower, 0, 1, 2, 3, 4, 5, 6, 7));
    store(column + 4 * stride, __builtin_shufflevector(lower, lower, 8, 9, 10, 11, 12, 13, 14, 15));
    store(column + 8 * stride, __builtin_shufflevector(upper, upper, 0, 1, 2, 3, 4, 5, 6, 7));
    store(column + 12 * stride,
          __builtin_shufflevector(upper, upper, 8, 9, 10, 11, 12, 13, 14, 15));
  }
}

/// The same for four vectors.
inline void storeFourColumns(const Lanes rows[4], float* to, std::size_t stride) {
  Lanes columns[4];
  transposeFour(rows, columns);
  for (std::size_t n = 0; n < 4; ++n) {
    const Lanes all = columns[n];
    float* column = to + n * stride;
    store(column, __builtin_shufflevector(all, all, 0, 1, 2, 3));
    store(column + 4 * stride, __builtin_shufflevector(all, all, 4, 5, 6, 7));
    store(column + 8 * stride, __builtin_shufflevector(all, all, 8, 9, 10, 11));
    store(column + 12 * stride, __builtin_shufflevector(all, all, 12, 13, 14, 15));
  }
}

}  // namespace
}  // namespace galactic::simulation
