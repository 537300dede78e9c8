#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>

#include "column_grid/blocked_intervals.h"
#include "column_grid/triangle_interval.h"
#include "engines/columns_by_rows.h"
#include "engines/embree.h"
#include "galactic/bake/column_engines.h"

namespace galactic::bake {
namespace {

#if RTC_VERSION_MAJOR >= 4
using RayContext = RTCRayQueryContext;
#else
using RayContext = RTCIntersectContext;
#endif

/// Boxes grow by this share of their coordinates, several units in the last place, to allow for the
/// rounding of box and ray.
constexpr float kBoxSlack = 1e-6F;

/// What the geometry's callbacks read.
struct DilatedMesh {
  const TriangleMesh& mesh;
  double radius = 0;

  [[nodiscard]] std::array<Point, 3> corners(unsigned triangle) const {
    return pointsOf(mesh, mesh.triangles[triangle]);
  }
};

/// One ray with all that it meets. The context comes first, because Embree passes its address to
/// the callback.
struct ColumnRay {
  RayContext context;
  /// The column in double; the ray's floats are only rounded from these.
  double x = 0;
  double z = 0;
  std::vector<BlockedInterval>* blocked = nullptr;
};
static_assert(std::is_standard_layout_v<ColumnRay>);

void boundTriangle(const RTCBoundsFunctionArguments* arguments) {
  const auto& dilated = *static_cast<const DilatedMesh*>(arguments->geometryUserPtr);
  const std::array<Point, 3> corners = dilated.corners(arguments->primID);
  std::array<float, 3> lower{};
  std::array<float, 3> upper{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [least, most] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
    const auto lo = static_cast<float>(least - dilated.radius);
    const auto hi = static_cast<float>(most + dilated.radius);
    const float slack = kBoxSlack * std::max(std::abs(lo), std::abs(hi));
    lower[axis] = lo - slack;
    upper[axis] = hi + slack;
  }
  RTCBounds& bounds = *arguments->bounds_o;
  bounds.lower_x = lower[0];
  bounds.lower_y = lower[1];
  bounds.lower_z = lower[2];
  bounds.upper_x = upper[0];
  bounds.upper_y = upper[1];
  bounds.upper_z = upper[2];
}

/// Records the interval and accepts no hit, so that the ray passes through everything.
void intersectTriangle(const RTCIntersectFunctionNArguments* arguments) {
  const auto& dilated = *static_cast<const DilatedMesh*>(arguments->geometryUserPtr);
  const auto& ray = *reinterpret_cast<const ColumnRay*>(arguments->context);
  const auto heights =
      touchingHeights(dilated.corners(arguments->primID), ray.x, ray.z, dilated.radius);
  if (!heights) return;
  ray.blocked->push_back({static_cast<float>(heights->lo), static_cast<float>(heights->hi)});
}

/// Embree fails only if memory runs out or if it does not support this processor.
tl::unexpected<Error> embreeFailure(RTCDevice device) {
  const bool out_of_memory = rtcGetDeviceError(device) == RTC_ERROR_OUT_OF_MEMORY;
  return fail(ErrorCode::kInternal, "`engine`",
              out_of_memory ? "ran out of memory building its scene; use `engine` exact"
                            : "could not build its scene; use `engine` exact");
}

Result<EmbreeScene> buildScene(RTCDevice device, DilatedMesh& dilated) {
  EmbreeScene scene(rtcNewScene(device));
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  if (!scene || geometry == nullptr) return embreeFailure(device);
  // Robust, because a ray along an axis may lie exactly in a box's face.
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(dilated.mesh.triangles.size()));
  rtcSetGeometryUserData(geometry, &dilated);
  rtcSetGeometryBoundsFunction(
      geometry, [](const RTCBoundsFunctionArguments* arguments) { boundTriangle(arguments); },
      nullptr);
  rtcSetGeometryIntersectFunction(geometry, [](const RTCIntersectFunctionNArguments* arguments) {
    intersectTriangle(arguments);
  });
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene.get());
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) return embreeFailure(device);
  return scene;
}

/// Sends one ray up a column; `blocked` receives the intervals, in no particular order.
void trace(RTCScene scene, const GridFrame& frame, ColumnIndex at,
           std::vector<BlockedInterval>& blocked) {
  blocked.clear();
  ColumnRay ray{};
  ray.x = frame.centerX(at.i);
  ray.z = frame.centerZ(at.k);
  ray.blocked = &blocked;
  RTCRayHit hit{};
  hit.ray.org_x = static_cast<float>(ray.x);
  hit.ray.org_y = frame.heights.lo;
  hit.ray.org_z = static_cast<float>(ray.z);
  hit.ray.dir_y = 1;
  hit.ray.tfar = frame.heights.hi - frame.heights.lo;
  hit.ray.mask = ~0U;
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&ray.context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &ray.context;
  rtcIntersect1(scene, &hit, &arguments);
#else
  rtcInitIntersectContext(&ray.context);
  rtcIntersect1(scene, &ray.context, &hit);
#endif
}

}  // namespace

Result<Columns> embreeColumns(const TriangleMesh& mesh, const GridFrame& frame, unsigned threads) {
  const std::string settings = "threads=" + std::to_string(std::max(1U, threads));
  const EmbreeDevice device(rtcNewDevice(settings.c_str()));
  if (!device) return embreeFailure(nullptr);
  DilatedMesh dilated{mesh, static_cast<double>(frame.radius)};
  const Result<EmbreeScene> scene = buildScene(device.get(), dilated);
  if (!scene) return tl::unexpected(scene.error());
  return columnsByRows(frame, threads, [&](std::uint32_t row) {
    RowSpans result;
    std::vector<BlockedInterval> blocked;
    for (std::uint32_t i = 0; i < frame.columns_x; ++i) {
      trace(scene->get(), frame, {i, row}, blocked);
      const std::size_t before = result.spans.size();
      appendFreeSpans(blocked, frame.heights, result.spans);
      result.counts.push_back(static_cast<std::uint32_t>(result.spans.size() - before));
    }
    return result;
  });
}

}  // namespace galactic::bake
