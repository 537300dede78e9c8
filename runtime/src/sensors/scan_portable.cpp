// The kernels of a scan for any processor, one beam at a time. scan_avx2.cpp repeats them operation
// by operation.
#include "sensors/scan_kernels.h"
#include "support/processor.h"

namespace galactic::sensors {
namespace {

// Like minps and maxps: return the second number if either is NaN.
float least(float a, float b) { return a < b ? a : b; }
float most(float a, float b) { return a > b ? a : b; }

/// Direction of a beam in the ground plane, world frame.
struct Heading {
  float x = 0;
  float z = 0;
};

Heading headingOf(const BeamBatch& beams, std::size_t n) {
  return {beams.cosine * beams.ahead[n] + beams.sine * beams.right[n],
          beams.cosine * beams.right[n] - beams.sine * beams.ahead[n]};
}

/// The cell of a coordinate, in cells. Coordinates outside and NaN give a cell of the ring.
std::int32_t cellOf(float coordinate, std::int32_t count) {
  return static_cast<std::int32_t>(least(most(coordinate, 0), static_cast<float>(count - 1)));
}

float castScene(const ScanPlaneView& plane, const BeamBatch& beams, const Heading& heading) {
  const float from_x = (beams.origin.x - plane.min_x) * plane.inverse_spacing;
  const float from_z = (beams.origin.z - plane.min_z) * plane.inverse_spacing;
  const float inverse_x = 1 / heading.x;
  const float inverse_z = 1 / heading.z;
  const float beyond_x = heading.x > 0 ? 1 : 0;
  const float beyond_z = heading.z > 0 ? 1 : 0;
  const float range = beams.range * plane.inverse_spacing;
  float way = 0;
  while (way < range) {
    const std::int32_t i = cellOf(from_x + way * heading.x, plane.columns_x);
    const std::int32_t k = cellOf(from_z + way * heading.z, plane.columns_z);
    const std::uint8_t cell = plane.cells[k * plane.columns_x + i];
    if (cell == 0) break;
    const float leave_x = ((static_cast<float>(i) + beyond_x) - from_x) * inverse_x;
    const float leave_z = ((static_cast<float>(k) + beyond_z) - from_z) * inverse_z;
    const float jump = way + (static_cast<float>(cell) - 1) * kJump;
    const float next = most(least(leave_x, leave_z), jump);
    way = next + most(next * kNudgeOfWay, kNudge);
  }
  return least(way * plane.spacing, beams.range);
}

void castScenePortable(const ScanPlaneView& plane, const BeamBatch& beams,
                       float* distances) noexcept {
  for (std::size_t n = 0; n < beams.count; ++n) {
    distances[n] = castScene(plane, beams, headingOf(beams, n));
  }
}

/// The part of a beam that lies within all slabs so far, meters.
struct Within {
  float from = 0;
  float to = 0;

  /// Cuts the part to another slab. `along`: the beam's direction along the slab's axis; `to_low`,
  /// `to_high`: distances along that axis from the beam's start to the slab's faces.
  void keep(float along, float to_low, float to_high) {
    const float inverse = 1 / along;
    const float low = to_low * inverse;
    const float high = to_high * inverse;
    from = most(least(low, high), from);
    to = least(most(low, high), to);
  }
};

/// Distances along an axis of a box from a point to its two faces.
struct Faces {
  Faces(const Vec3& axis, float half, const Vec3& offset)
      : low(-half - dot(axis, offset)), high(half - dot(axis, offset)) {}

  float low;
  float high;
};

void castBoxPortable(const simulation::RestingBox& box, const BeamBatch& beams,
                     float* distances) noexcept {
  const Vec3 offset = beams.origin - box.center;
  const Faces x(box.axis_x, box.half_extents.x, offset);
  const Faces y(box.axis_y, box.half_extents.y, offset);
  const Faces z(box.axis_z, box.half_extents.z, offset);
  for (std::size_t n = 0; n < beams.count; ++n) {
    const Heading heading = headingOf(beams, n);
    Within within{0, distances[n]};
    within.keep(box.axis_x.x * heading.x + box.axis_x.z * heading.z, x.low, x.high);
    within.keep(box.axis_y.x * heading.x + box.axis_y.z * heading.z, y.low, y.high);
    within.keep(box.axis_z.x * heading.x + box.axis_z.z * heading.z, z.low, z.high);
    if (within.from <= within.to) distances[n] = within.from;
  }
}

}  // namespace

ScanKernels portableScan() noexcept { return {castScenePortable, castBoxPortable}; }

ScanKernels scanKernels() noexcept { return detail::hasAvx2() ? avx2Scan() : portableScan(); }

}  // namespace galactic::sensors
