// The only file of this folder that names Embree; versions 3 and 4.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <vector>

#include "episodes/surface_rays.h"

namespace galactic::bake {
namespace {

/// Rays begin this high over the surface, metres: under what may hang over an object.
constexpr float kAbove = 0.015F;
/// The least cosine of a surface's normal with the vertical: 15 degrees, for scanned surfaces.
constexpr float kUpright = 0.966F;

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceRelease>;
using TriangleScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneRelease>;

RTCRayHit rayDown(float x, float z, float from, float length) {
  RTCRayHit hit{};
  hit.ray.org_x = x;
  hit.ray.org_y = from;
  hit.ray.org_z = z;
  hit.ray.dir_y = -1;
  hit.ray.tfar = length;
  hit.ray.mask = ~0U;
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return hit;
}

void trace(RTCScene scene, RTCRayHit& hit) {
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(scene, &hit);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &hit);
#endif
}

/// Whether the triangle that was met lies flat, either side up: sources turn them as they like.
bool isUpright(const RTCHit& hit) {
  const float length = std::sqrt(hit.Ng_x * hit.Ng_x + hit.Ng_y * hit.Ng_y + hit.Ng_z * hit.Ng_z);
  return std::abs(hit.Ng_y) >= kUpright * length;
}

}  // namespace

struct SurfaceRays::Scene {
  Device device;
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  TriangleScene triangle_scene;
};

SurfaceRays::SurfaceRays(std::unique_ptr<Scene> scene) : scene_(std::move(scene)) {}
SurfaceRays::~SurfaceRays() = default;
SurfaceRays::SurfaceRays(SurfaceRays&& other) noexcept = default;
SurfaceRays& SurfaceRays::operator=(SurfaceRays&& other) noexcept = default;

Result<SurfaceRays> SurfaceRays::build(const TriangleMesh& mesh) {
  const auto failure = [] {
    return fail(ErrorCode::kInternal, "episodes",
                "could not build a scene for rays, for lack of memory; generate without geometry");
  };
  auto scene = std::make_unique<Scene>();
  // Rays on an edge are judged differently by different instructions: SSE2 is what all x86-64
  // processors have. Other processors have one set anyway.
#if defined(__x86_64__)
  scene->device.reset(rtcNewDevice("isa=sse2,threads=1"));
#else
  scene->device.reset(rtcNewDevice("threads=1"));
#endif
  if (!scene->device) return failure();
  scene->positions = mesh.vertices;
  // Embree reads 16 bytes for each position, so there must be some behind the last.
  scene->positions.emplace_back();
  scene->triangles = mesh.triangles;
  scene->triangle_scene.reset(rtcNewScene(scene->device.get()));
  const RTCGeometry geometry = rtcNewGeometry(scene->device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  if (!scene->triangle_scene || geometry == nullptr) return failure();
  rtcSetSceneFlags(scene->triangle_scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             scene->positions.data(), 0, sizeof(Vec3), scene->positions.size() - 1);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             scene->triangles.data(), 0, sizeof(Triangle), scene->triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene->triangle_scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene->triangle_scene.get());
  if (rtcGetDeviceError(scene->device.get()) != RTC_ERROR_NONE) return failure();
  return SurfaceRays(std::move(scene));
}

bool SurfaceRays::isEven(const Footprint& footprint, float surface, float flatness) const {
  const auto steps = [](float half) {
    return std::max(1, static_cast<int>(std::ceil(2 * half / kRayDistance)));
  };
  const int along = steps(footprint.half_length);
  const int across = steps(footprint.half_width);
  for (int a = 0; a <= along; ++a) {
    const float length =
        footprint.half_length * (2 * static_cast<float>(a) / static_cast<float>(along) - 1);
    for (int b = 0; b <= across; ++b) {
      const float width =
          footprint.half_width * (2 * static_cast<float>(b) / static_cast<float>(across) - 1);
      const float x = footprint.x + footprint.along_x * length - footprint.along_z * width;
      const float z = footprint.z + footprint.along_z * length + footprint.along_x * width;
      RTCRayHit hit = rayDown(x, z, surface + kAbove, kAbove + flatness);
      trace(scene_->triangle_scene.get(), hit);
      if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID || !isUpright(hit.hit)) return false;
      if (hit.ray.tfar < kAbove - flatness) return false;
    }
  }
  return true;
}

}  // namespace galactic::bake
