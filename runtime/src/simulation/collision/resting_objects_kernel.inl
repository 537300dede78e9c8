// Finds which spheres overlap resting objects, with vectors of eight. Included by
// resting_objects_portable.cpp and resting_objects_avx2.cpp, which differ only in the instructions
// that they may use. No library templates here: see column_grid_avx2.cpp.
#include "simulation/collision/packed_bounds.inl"
// The second needs the first.
#include "simulation/lanes/lanes_eight.inl"
#include "simulation/lanes/operations.inl"

namespace galactic::simulation {
namespace {

struct Centers {
  Lanes x, y, z;
};

inline Centers centersAt(const float* x, const float* y, const float* z, std::size_t n) {
  return {load(x + n), load(y + n), load(z + n)};
}

/// The cells of eight coordinates, like cellOf() in resting_objects.cpp.
inline IntLanes cellsOf(Lanes coordinates, Lanes per_meter) {
  const Lanes below = lesser(spread(kFarthestCell), coordinates * per_meter);
  return nearestWhole(greater(spread(-kFarthestCell), below));
}

inline QueryBounds boundsOf(const Centers& centers) {
  CellSpan x;
  CellSpan y;
  CellSpan z;
  spanOf(cellsOf(centers.x, spread(1 / kCellEdge)), x.first, x.last);
  spanOf(cellsOf(centers.y, spread(1 / kBandHeight)), y.first, y.last);
  spanOf(cellsOf(centers.z, spread(1 / kCellEdge)), z.first, z.last);
  return queryBounds(x, y, z);
}

inline QueryBounds boundsOf(const CenterBounds& bounds) {
  constexpr float kCells = 1 / kCellEdge;
  constexpr float kHeights = 1 / kBandHeight;
  const Lanes per_meter{kCells, kCells, kHeights, kHeights, kCells, kCells, kCells, kCells};
  // Loads halves, because some callers write halves: a load of the whole vector would stall.
  const Lanes values = __builtin_shufflevector(
      loadFour(bounds.values), loadFour(bounds.values + kLanes / 2), 0, 1, 2, 3, 4, 5, 6, 7);
  std::int32_t cells[kLanes];
  storeInts(cells, cellsOf(values, per_meter));
  return queryBounds({cells[0], cells[1]}, {cells[2], cells[3]}, {cells[4], cells[5]});
}

inline Lanes absolute(Lanes value) {
  constexpr std::int32_t kAllButSign = 0x7fff'ffff;
  return reinterpret_cast<Lanes>(reinterpret_cast<IntLanes>(value) & kAllButSign);
}

/// How far centers lie beyond the two faces across one axis: 0 between the faces; NaN stays NaN.
inline Lanes beyond(const Vec3& axis, float half, const Centers& offset) {
  const Lanes along =
      spread(axis.x) * offset.x + spread(axis.y) * offset.y + spread(axis.z) * offset.z;
  return greater(absolute(along) - spread(half), spread(0));
}

/// The lanes that overlap a box, as bits.
inline unsigned overlapping(const RestingBox& box, const Centers& centers, float radius) {
  const Lanes up = centers.y - spread(box.center.y);
  const IntLanes at_height = absolute(up) < spread(box.half_height + radius);
  if (signsOf(at_height) == 0) return 0;
  const Centers offset{centers.x - spread(box.center.x), up, centers.z - spread(box.center.z)};
  const Lanes x = beyond(box.axis_x, box.half_extents.x, offset);
  const Lanes y = beyond(box.axis_y, box.half_extents.y, offset);
  const Lanes z = beyond(box.axis_z, box.half_extents.z, offset);
  const Lanes squared = x * x + y * y + z * z;
  return signsOf((squared < spread(radius * radius)) & at_height);
}

/// The lanes that overlap an object; checks only objects whose bounds overlap those of all eight
/// lanes.
inline unsigned touchingLanes(const RestingView& objects, const Centers& centers, float radius) {
  const QueryBounds query = boundsOf(centers);
  unsigned lanes = 0;
  for (std::size_t p = 0; p < objects.bounds_count; ++p) {
    const RestingBox* boxes = objects.boxes + p * kPackedObjects;
    for (std::uint32_t near = objectsNear(objects, p, query); near != 0; near &= near - 1) {
      lanes |= overlapping(boxes[__builtin_ctz(near)], centers, radius);
    }
  }
  return lanes;
}

bool findTouchingKernel(const RestingView& given_objects, const SphereBatch& given_spheres,
                        LaneGroup& at) noexcept {
  // Copies, so that the compiler knows that no write below changes them.
  const RestingView objects = given_objects;
  const SphereBatch spheres = given_spheres;
  std::size_t group = at.group;
  for (std::size_t r = at.range; r < spheres.ranges.count; ++r, group = 0) {
    const RadiusRange range = spheres.ranges.first[r];
    const std::size_t end = std::size_t{range.first} + range.count;
    for (std::size_t n = range.first + group * kLanes; n < end; n += kLanes) {
      const Centers centers = centersAt(spheres.x, spheres.y, spheres.z, n);
      const unsigned lanes = touchingLanes(objects, centers, range.radius);
      if (lanes == 0) continue;
      at = {r, (n - range.first) / kLanes, lanes};
      return true;
    }
  }
  return false;
}

bool mayTouchKernel(const RestingView& objects, const CenterBounds& bounds) noexcept {
  const QueryBounds query = boundsOf(bounds);
  std::uint32_t any = 0;
  for (std::size_t p = 0; p < objects.bounds_count; ++p) {
    const std::uint32_t near = objectsNear(objects, p, query);
    any |= near;
    // The caller looks at these objects next, mostly at one. Their number is unpredictable, so
    // there is no loop.
    if (near != 0) {
      __builtin_prefetch(objects.boxes + p * kPackedObjects +
                         static_cast<std::size_t>(__builtin_ctz(near)));
    }
  }
  return any != 0;
}

/// Bounds of eight groups of spheres, with the members of QueryBounds.
struct EightBounds {
  IntLanes least_x, most_x, least_z, most_z, bands, is_everywhere;
};

inline IntLanes bandsOf(IntLanes first, IntLanes last) {
  const IntLanes further = last - first;
  const IntLanes run = (2 << (further & (kBands - 1))) - 1;
  const IntLanes by = first & (kBands - 1);
  const IntLanes bands = run << by | run >> (kBands - by);
  const IntLanes in_all = (further < 0) | (further >= kBands - 1);
  return in_all ? IntLanes{} + std::int32_t{kAllBands} : bands;
}

/// `bounds`: of the first group, `stride` apart.
inline EightBounds boundsOfEight(const float* bounds, std::size_t stride) {
  const Lanes cells = spread(1 / kCellEdge);
  const Lanes heights = spread(1 / kBandHeight);
  EightBounds eight;
  eight.least_x = cellsOf(load(bounds), cells);
  eight.most_x = cellsOf(load(bounds + stride), cells);
  eight.bands = bandsOf(cellsOf(load(bounds + 2 * stride), heights),
                        cellsOf(load(bounds + 3 * stride), heights));
  eight.least_z = cellsOf(load(bounds + 4 * stride), cells);
  eight.most_z = cellsOf(load(bounds + 5 * stride), cells);
  const IntLanes wide = eight.most_x - eight.least_x;
  const IntLanes deep = eight.most_z - eight.least_z;
  eight.is_everywhere = (wide < 0) | (wide > kMostByteCells) | (deep < 0) | (deep > kMostByteCells);
  return eight;
}

/// The groups of an eight whose bounds overlap those of object `n`, as bits: objectsNear() the
/// other way around.
inline unsigned groupsNear(const PackedBounds& objects, std::size_t n, const EightBounds& eight) {
  // Shifts the sign of a byte to that of an integer.
  constexpr int kAbove = 24;
  const IntLanes apart = ((eight.most_x - std::int32_t{objects.least_x[n]}) |
                          (std::int32_t{objects.most_x[n]} - eight.least_x) |
                          (eight.most_z - std::int32_t{objects.least_z[n]}) |
                          (std::int32_t{objects.most_z[n]} - eight.least_z))
                         << kAbove;
  const auto is_object_everywhere = -static_cast<std::int32_t>(objects.everywhere >> n & 1U);
  const IntLanes in_other_bands = (eight.bands & std::int32_t{objects.bands[n]}) == 0;
  return signsOf((~apart | eight.is_everywhere | is_object_everywhere) & ~in_other_bands);
}

/// Whether any sphere overlaps one of the `objects`, given as bits, of one pack.
inline bool touchesSome(const PackedBounds& bounds, const RestingBox* boxes, std::uint32_t objects,
                        const BoundedSpheres& spheres) {
  for (std::size_t first = 0; first < spheres.group_count; first += kLanes) {
    const std::size_t count = spheres.group_count - first;
    const unsigned groups = count < kLanes ? (1U << count) - 1 : (1U << kLanes) - 1;
    const EightBounds eight = boundsOfEight(spheres.bounds + first, spheres.bounds_stride);
    for (std::uint32_t left = objects; left != 0; left &= left - 1) {
      const auto n = static_cast<std::size_t>(__builtin_ctz(left));
      unsigned near = groups & groupsNear(bounds, n, eight);
      for (; near != 0; near &= near - 1) {
        const std::size_t group = first + static_cast<std::size_t>(__builtin_ctz(near));
        const Centers centers = centersAt(spheres.x, spheres.y, spheres.z, group * kLanes);
        if (overlapping(boxes[n], centers, spheres.radii[group]) != 0) return true;
      }
    }
  }
  return false;
}

bool touchesKernel(const RestingView& given_objects, const BoundedSpheres& given_spheres) noexcept {
  const RestingView objects = given_objects;
  const BoundedSpheres spheres = given_spheres;
  const QueryBounds query = boundsOf(*spheres.all);
  for (std::size_t p = 0; p < objects.bounds_count; ++p) {
    const std::uint32_t near = objectsNear(objects, p, query);
    if (near == 0) continue;
    const RestingBox* boxes = objects.boxes + p * kPackedObjects;
    if (touchesSome(objects.bounds[p], boxes, near, spheres)) return true;
  }
  return false;
}

}  // namespace
}  // namespace galactic::simulation
