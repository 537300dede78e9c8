// The only file compiled for AVX2. It includes no header whose inline functions it could
// instantiate: the linker may keep one copy of such a function for the whole program, and a copy
// built here would not run on an older processor.
#include "column_grid/column_grid_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

#include "column_grid/column_query.inl"

namespace galactic::detail {
namespace {

void storeClearance(const Found& found, Clearance* out) {
  const __m256i one = _mm256_set1_epi32(static_cast<int>(Clearance::kBlocked));
  const __m256i two = _mm256_set1_epi32(static_cast<int>(Clearance::kOutside));
  const __m256i over_grid = _mm256_andnot_si256(_mm256_castps_si256(found.free), one);
  const __m256i elsewhere = _mm256_blendv_epi8(two, one, _mm256_castps_si256(found.not_a_number));
  const __m256i answer =
      _mm256_blendv_epi8(elsewhere, over_grid, _mm256_castps_si256(found.inside));
  // The lowest byte of each lane, side by side.
  const __m256i bytes = _mm256_shuffle_epi8(answer, _mm256_set1_epi32(0x0c080400));
  const __m128i eight =
      _mm_unpacklo_epi32(_mm256_castsi256_si128(bytes), _mm256_extracti128_si256(bytes, 1));
  _mm_storel_epi64(reinterpret_cast<__m128i*>(out), eight);
}

/// Answers the lanes whose cells keep their spans in the overflow block one by one: there are few.
void answerOverflow(const ColumnGridLayout& grid, const ContactBatch& batch, std::size_t first,
                    const Found& found) {
  alignas(32) std::uint32_t start[kLanes];
  _mm256_store_si256(reinterpret_cast<__m256i*>(start), found.upper_half);
  auto lanes = static_cast<unsigned>(_mm256_movemask_ps(found.overflow));
  while (lanes != 0) {
    const auto lane = static_cast<std::size_t>(__builtin_ctz(lanes));
    lanes &= lanes - 1;
    const Contact contact = contactInOverflow(grid, start[lane], batch.y[first + lane]);
    batch.clearance[first + lane] = contact.clearance;
    if (batch.down == nullptr) continue;
    batch.down[first + lane] = contact.down;
    batch.up[first + lane] = contact.up;
  }
}

}  // namespace

void contactAvx2(const ColumnGridLayout& grid, const ContactBatch& batch) noexcept {
  std::size_t first = 0;
  if (readsWholePairs(grid)) {
    const Lanes lanes = broadcast(grid);
    const __m256 quantum = _mm256_set1_ps(grid.quantum);
    const __m256 margin = _mm256_set1_ps(batch.down == nullptr ? 0.0F : contactMargin(grid));
    for (; first + kLanes <= batch.count; first += kLanes) {
      const Found found = find(grid, lanes, _mm256_loadu_ps(batch.x + first),
                               _mm256_loadu_ps(batch.y + first), _mm256_loadu_ps(batch.z + first));
      storeClearance(found, batch.clearance + first);
      if (batch.down != nullptr) {
        const __m256 above = _mm256_sub_ps(lanes.highest, _mm256_loadu_ps(batch.y + first));
        const __m256 down =
            clearOf(_mm256_mul_ps(_mm256_sub_ps(found.code, found.lo), quantum), margin);
        const __m256 up = clearOf(
            _mm256_min_ps(_mm256_mul_ps(_mm256_sub_ps(found.hi, found.code), quantum), above),
            margin);
        _mm256_storeu_ps(batch.down + first, _mm256_and_ps(down, found.free));
        _mm256_storeu_ps(batch.up + first, _mm256_and_ps(up, found.free));
      }
      if (_mm256_movemask_ps(found.overflow) != 0) answerOverflow(grid, batch, first, found);
    }
  }
  if (first == batch.count) return;
  const bool distances = batch.down != nullptr;
  contactPortable(grid, {batch.x + first, batch.y + first, batch.z + first, batch.count - first,
                         batch.clearance + first, distances ? batch.down + first : nullptr,
                         distances ? batch.up + first : nullptr});
}

std::size_t firstNotFreeAvx2(const ColumnGridLayout& grid, const CenterBatch& batch) noexcept {
  std::size_t first = 0;
  if (readsWholePairs(grid)) {
    const Lanes lanes = broadcast(grid);
    for (; first + kLanes <= batch.count; first += kLanes) {
      const __m256 y = _mm256_loadu_ps(batch.y + first);
      const unsigned not_free = notFreeLanes(grid, lanes, _mm256_loadu_ps(batch.x + first), y,
                                             _mm256_loadu_ps(batch.z + first));
      if (not_free != 0) return first + static_cast<std::size_t>(__builtin_ctz(not_free));
    }
  }
  const CenterBatch rest{batch.x + first, batch.y + first, batch.z + first, batch.count - first};
  return rest.count == 0 ? first : first + firstNotFreePortable(grid, rest);
}

std::uint64_t notFreeAvx2(const ColumnGridLayout& grid, const EightsOfCenters& centers) noexcept {
  if (!readsWholePairs(grid)) return notFreePortable(grid, centers);
  const Lanes lanes = broadcast(grid);
  std::uint64_t not_free = 0;
  for (unsigned left = centers.eights; left != 0; left &= left - 1) {
    const std::size_t n = static_cast<std::size_t>(__builtin_ctz(left)) * kLanes;
    const unsigned bits =
        notFreeLanes(grid, lanes, _mm256_loadu_ps(centers.x + n), _mm256_loadu_ps(centers.y + n),
                     _mm256_loadu_ps(centers.z + n));
    not_free |= std::uint64_t{bits} << n;
  }
  return not_free;
}

}  // namespace galactic::detail

#else

namespace galactic::detail {

// hasAvx2() is false on this architecture; the symbol exists so that callers need no condition.
void contactAvx2(const ColumnGridLayout& grid, const ContactBatch& batch) noexcept {
  contactPortable(grid, batch);
}

std::size_t firstNotFreeAvx2(const ColumnGridLayout& grid, const CenterBatch& batch) noexcept {
  return firstNotFreePortable(grid, batch);
}

std::uint64_t notFreeAvx2(const ColumnGridLayout& grid, const EightsOfCenters& centers) noexcept {
  return notFreePortable(grid, centers);
}

}  // namespace galactic::detail

#endif
