// Which spheres overlap resting objects, in terms of vectors of eight: included by
// resting_objects_portable.cpp and resting_objects_avx2.cpp, which differ in nothing else but the
// instructions that they may use. No library templates here: see column_grid_avx2.cpp.
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

/// Cells of eight coordinates, as cellOf() of resting_objects.cpp.
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
  std::int32_t cells[kLanes];
  storeInts(cells, cellsOf(load(bounds.values), per_meter));
  return queryBounds({cells[0], cells[1]}, {cells[2], cells[3]}, {cells[4], cells[5]});
}

inline Lanes absolute(Lanes value) {
  constexpr std::int32_t kAllButSign = 0x7fff'ffff;
  return reinterpret_cast<Lanes>(reinterpret_cast<IntLanes>(value) & kAllButSign);
}

/// How far beyond the faces across one axis: 0 between them; NaN stays NaN.
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

/// The lanes that overlap an object, of those that the bounds of all eight meet.
inline unsigned touchingLanes(const RestingView& objects, const Centers& centers, float radius) {
  const QueryBounds query = boundsOf(centers);
  unsigned lanes = 0;
  for (std::size_t p = 0; p < objects.bounds_count; ++p) {
    const RestingBox* boxes = objects.boxes + p * kPackedObjects;
    for (std::uint32_t near = objectsNear(objects.bounds[p], query); near != 0; near &= near - 1) {
      lanes |= overlapping(boxes[__builtin_ctz(near)], centers, radius);
    }
  }
  return lanes;
}

bool findTouchingKernel(const RestingView& given_objects, const SphereBatch& given_spheres,
                        LaneGroup& at) noexcept {
  // Copies: nothing that is written below can change them.
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
  std::uint32_t near = 0;
  for (std::size_t p = 0; p < objects.bounds_count; ++p) {
    near |= objectsNear(objects.bounds[p], query);
  }
  return near != 0;
}

/// How far a box reaches along one axis of the world, as halfBounds().
inline float halfAlong(const RestingBox& box, float Vec3::*axis) {
  return __builtin_fabsf(box.axis_x.*axis) * box.half_extents.x +
         __builtin_fabsf(box.axis_y.*axis) * box.half_extents.y +
         __builtin_fabsf(box.axis_z.*axis) * box.half_extents.z;
}

/// Which of eight groups of spheres a box is apart from along an axis. `bounds`: least, then most.
inline IntLanes apartAlong(float center, float half, Lanes radii, const float* bounds,
                           std::size_t stride) {
  const float slack = kBoundsSlack + kRelativeBoundsSlack * __builtin_fabsf(center);
  const Lanes reach = (radii + spread(half)) * spread(1 + kRelativeBoundsSlack) + spread(slack);
  return (load(bounds) > spread(center) + reach) | (load(bounds + stride) < spread(center) - reach);
}

/// The groups of an eight that may overlap a box, as bits.
inline unsigned groupsNear(const RestingBox& box, const BoundedSpheres& spheres,
                           std::size_t first) {
  const Lanes radii = load(spheres.radii + first);
  const float* bounds = spheres.bounds + first;
  const std::size_t stride = spheres.bounds_stride;
  const IntLanes apart =
      apartAlong(box.center.x, halfAlong(box, &Vec3::x), radii, bounds, stride) |
      apartAlong(box.center.y, box.half_height, radii, bounds + 2 * stride, stride) |
      apartAlong(box.center.z, halfAlong(box, &Vec3::z), radii, bounds + 4 * stride, stride);
  const std::size_t left = spheres.group_count - first;
  const unsigned groups = left < kLanes ? (1U << left) - 1 : (1U << kLanes) - 1;
  return groups & ~signsOf(apart);
}

inline bool touchesBox(const RestingBox& box, const BoundedSpheres& spheres) {
  for (std::size_t first = 0; first < spheres.group_count; first += kLanes) {
    for (unsigned near = groupsNear(box, spheres, first); near != 0; near &= near - 1) {
      const std::size_t group = first + static_cast<std::size_t>(__builtin_ctz(near));
      const Centers centers = centersAt(spheres.x, spheres.y, spheres.z, group * kLanes);
      if (overlapping(box, centers, spheres.radii[group]) != 0) return true;
    }
  }
  return false;
}

bool touchesKernel(const RestingView& given_objects, const BoundedSpheres& given_spheres) noexcept {
  const RestingView objects = given_objects;
  const BoundedSpheres spheres = given_spheres;
  const QueryBounds query = boundsOf(*spheres.all);
  for (std::size_t p = 0; p < objects.bounds_count; ++p) {
    const RestingBox* boxes = objects.boxes + p * kPackedObjects;
    for (std::uint32_t near = objectsNear(objects.bounds[p], query); near != 0; near &= near - 1) {
      if (touchesBox(boxes[__builtin_ctz(near)], spheres)) return true;
    }
  }
  return false;
}

}  // namespace
}  // namespace galactic::simulation
