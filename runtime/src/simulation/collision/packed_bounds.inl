// Compares bounds with those of 32 objects. Included by resting_objects.cpp and by the kernels,
// which may use other instructions. No library templates here: see column_grid_avx2.cpp.
#include "simulation/collision/resting_objects_kernels.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace galactic::simulation {
namespace {

/// Objects that the processor compares at once.
#if defined(__AVX2__)
constexpr std::uint32_t kAtOnce = kPackedObjects;
#else
constexpr std::uint32_t kAtOnce = kPackedObjects / 2;
#endif
using Bytes = std::uint8_t __attribute__((vector_size(kAtOnce)));

inline Bytes loadBytes(const std::uint8_t* from) {
  Bytes bytes;
  __builtin_memcpy(&bytes, from, sizeof(bytes));
  return bytes;
}

/// The highest bit of each byte.
inline std::uint32_t signsOf(const Bytes& bytes) {
#if defined(__AVX2__)
  return static_cast<std::uint32_t>(_mm256_movemask_epi8(reinterpret_cast<__m256i>(bytes)));
#elif defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_epi8(reinterpret_cast<__m128i>(bytes)));
#else
  std::uint32_t signs = 0;
  for (std::uint32_t n = 0; n < kAtOnce; ++n) {
    signs |= static_cast<std::uint32_t>(bytes[n] >> 7U) << n;
  }
  return signs;
#endif
}

/// The bands from the first to the last one, as bits.
constexpr std::uint8_t bandsOf(const CellSpan& span) {
  const std::int32_t further = span.last - span.first;
  if (further < 0 || further >= kBands - 1) return kAllBands;
  const std::uint32_t run = (2U << static_cast<std::uint32_t>(further)) - 1;
  constexpr std::uint32_t kTurn = kBands;
  const std::uint32_t by = static_cast<std::uint32_t>(span.first) % kTurn;
  return static_cast<std::uint8_t>(run << by | run >> (kTurn - by));
}

constexpr bool isEverywhere(const CellSpan& x, const CellSpan& z) {
  const auto reaches_far = [](const CellSpan& span) {
    return static_cast<std::uint32_t>(span.last - span.first) >
           static_cast<std::uint32_t>(kMostByteCells);
  };
  return reaches_far(x) || reaches_far(z);
}

constexpr QueryBounds queryBounds(const CellSpan& x, const CellSpan& bands, const CellSpan& z) {
  return {static_cast<std::uint8_t>(x.first),
          static_cast<std::uint8_t>(x.last),
          static_cast<std::uint8_t>(z.first),
          static_cast<std::uint8_t>(z.last),
          bandsOf(bands),
          isEverywhere(x, z)};
}

/// Of the objects compared at once, from `first` on, those that do not overlap the query along a
/// horizontal axis, as bits.
inline std::uint32_t apart(const PackedBounds& objects, const QueryBounds& query,
                           std::uint32_t first) {
  const Bytes x = (loadBytes(objects.most_x + first) - query.least_x) |
                  (query.most_x - loadBytes(objects.least_x + first));
  const Bytes z = (loadBytes(objects.most_z + first) - query.least_z) |
                  (query.most_z - loadBytes(objects.least_z + first));
  return signsOf(x | z) << first;
}

/// Of the same objects those that share no band with the query.
inline std::uint32_t inOtherBands(const PackedBounds& objects, const QueryBounds& query,
                                  std::uint32_t first) {
  const Bytes none{};
  const auto others = (loadBytes(objects.bands + first) & query.bands) == none;
  return signsOf(reinterpret_cast<Bytes>(others)) << first;
}

/// The objects whose bounds overlap those of a query, as bits.
inline std::uint32_t objectsNear(const PackedBounds& objects, const QueryBounds& query) {
  std::uint32_t apart_from = 0;
  std::uint32_t others = 0;
  for (std::uint32_t first = 0; first < kPackedObjects; first += kAtOnce) {
    apart_from |= apart(objects, query, first);
    others |= inOtherBands(objects, query, first);
  }
  const std::uint32_t everywhere = query.is_everywhere ? ~std::uint32_t{0} : objects.everywhere;
  return objects.resting & (everywhere | ~apart_from) & ~others;
}

/// The absent object as a bit, if it is in pack `p` of a view.
inline std::uint32_t absentOf(const RestingView& objects, std::size_t p) {
  return p == objects.absent_pack ? objects.absent : 0;
}

/// The objects in pack `p` of a view whose bounds overlap those of a query, as bits.
inline std::uint32_t objectsNear(const RestingView& objects, std::size_t p,
                                 const QueryBounds& query) {
  return objectsNear(objects.bounds[p], query) & ~absentOf(objects, p);
}

}  // namespace
}  // namespace galactic::simulation
