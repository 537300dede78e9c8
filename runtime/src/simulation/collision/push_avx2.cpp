// Compiled for AVX2: instantiates no library templates, see column_grid_avx2.cpp.
#include "column_grid/column_grid_kernels.h"
#include "simulation/collision/push_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

#include "column_grid/column_query.inl"

namespace galactic::simulation {
namespace {

constexpr int kNoLane = -1;
constexpr std::size_t kEight = 8;

/// How far into its cell a coordinate lies, in cells.
float partOf(float cell) {
  const __m128 value = _mm_set_ss(cell);
  return _mm_cvtss_f32(_mm_sub_ss(value, _mm_floor_ss(value, value)));
}

/// The free lane with the shortest way of at most `reach`, the last of equal ones.
int shortestOf(__m256 way, unsigned free, float reach) {
  const __m256i bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  const __m256i chosen = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(free)), bits);
  const __m256 may = _mm256_and_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(chosen, bits)),
                                   _mm256_cmp_ps(way, _mm256_set1_ps(reach), _CMP_LE_OQ));
  if (_mm256_movemask_ps(may) == 0) return kNoLane;
  const __m256 candidate = _mm256_blendv_ps(_mm256_set1_ps(reach), way, may);
  __m256 least = _mm256_min_ps(candidate, _mm256_permute2f128_ps(candidate, candidate, 1));
  least = _mm256_min_ps(least, _mm256_permute_ps(least, 0x4e));
  least = _mm256_min_ps(least, _mm256_permute_ps(least, 0xb1));
  const __m256 is_least = _mm256_and_ps(may, _mm256_cmp_ps(candidate, least, _CMP_EQ_OQ));
  return 31 - __builtin_clz(static_cast<unsigned>(_mm256_movemask_ps(is_least)));
}

}  // namespace

Push pushOutAvx2(const ColumnGridLayout& grid, const Vec3& center, float reach) noexcept {
  if (!detail::readsWholePairs(grid)) return pushOutPortable(grid, center, reach);
  const float part_x = partOf((center.x - grid.min_x) * grid.inverse_spacing);
  const float part_z = partOf((center.z - grid.min_z) * grid.inverse_spacing);
  const __m256 sign_x = _mm256_setr_ps(1, -1, 0, 0, 1, -1, 0, 0);
  const __m256 sign_z = _mm256_setr_ps(0, 0, 1, -1, 0, 0, 1, -1);
  const __m256 part =
      _mm256_setr_ps(-part_x, part_x, -part_z, part_z, -part_x, part_x, -part_z, part_z);
  const __m256 to_border = _mm256_add_ps(_mm256_setr_ps(1, 0, 1, 0, 2, 1, 2, 1), part);
  const detail::Lanes lanes = detail::broadcast(grid);
  const __m256 y = _mm256_set1_ps(center.y);
  const __m256 to = _mm256_mul_ps(to_border, _mm256_set1_ps(grid.spacing));
  for (int cells = 0; static_cast<float>(cells) * grid.spacing <= reach; cells += kCellsAtATime) {
    const float further = static_cast<float>(cells) * grid.spacing + kIntoCell;
    const __m256 way = _mm256_add_ps(to, _mm256_set1_ps(further));
    const __m256 x = _mm256_add_ps(_mm256_set1_ps(center.x), _mm256_mul_ps(way, sign_x));
    const __m256 z = _mm256_add_ps(_mm256_set1_ps(center.z), _mm256_mul_ps(way, sign_z));
    const int best = shortestOf(way, ~detail::notFreeLanes(grid, lanes, x, y, z), reach);
    if (best == kNoLane) continue;
    alignas(32) float ways[kEight];
    _mm256_store_ps(ways, way);
    constexpr float kX[kEight] = {1, -1, 0, 0, 1, -1, 0, 0};
    constexpr float kZ[kEight] = {0, 0, 1, -1, 0, 0, 1, -1};
    return {ways[best] * kX[best], ways[best] * kZ[best]};
  }
  return {};
}

}  // namespace galactic::simulation

#else

namespace galactic::simulation {

// hasAvx2() is false on this architecture; the symbol exists so that callers need no condition.
Push pushOutAvx2(const ColumnGridLayout& grid, const Vec3& center, float reach) noexcept {
  return pushOutPortable(grid, center, reach);
}

}  // namespace galactic::simulation

#endif
