// The only file of this folder that names Embree; versions 3 and 4.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <string>
#include <utility>

#include "ambient/occlusion_rays.h"

namespace galactic::bake {
namespace {

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceRelease>;
using TriangleScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneRelease>;

bool isOpen(RTCScene scene, const OcclusionRay& from, float distance) {
  RTCRay ray{};
  ray.org_x = from.origin.x;
  ray.org_y = from.origin.y;
  ray.org_z = from.origin.z;
  ray.dir_x = from.direction.x;
  ray.dir_y = from.direction.y;
  ray.dir_z = from.direction.z;
  ray.tfar = distance;
  ray.mask = ~0U;
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded1(scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
  // Embree marks what it met with a negative length.
  return ray.tfar >= 0;
}

}  // namespace

struct Occluders::Scene {
  Device device;
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  TriangleScene triangle_scene;
};

Occluders::Occluders(std::unique_ptr<Scene> scene) : scene_(std::move(scene)) {}
Occluders::~Occluders() = default;
Occluders::Occluders(Occluders&& other) noexcept = default;
Occluders& Occluders::operator=(Occluders&& other) noexcept = default;

Result<Occluders> Occluders::build(std::vector<Vec3> positions, std::vector<Triangle> triangles,
                                   unsigned jobs) {
  const auto failure = [] {
    return fail(ErrorCode::kInternal, "--ambient-occlusion",
                "could not build its scene, for lack of memory; bake without it");
  };
  auto scene = std::make_unique<Scene>();
  // Rays on an edge are judged differently by different instructions, and packs are compared byte
  // by byte: SSE2 is what all x86-64 processors have. Other processors have one set anyway.
#if defined(__x86_64__)
  const std::string settings = "isa=sse2,threads=" + std::to_string(std::max(1U, jobs));
#else
  const std::string settings = "threads=" + std::to_string(std::max(1U, jobs));
#endif
  scene->device.reset(rtcNewDevice(settings.c_str()));
  if (!scene->device) return failure();
  // Embree reads 16 bytes for each position, so there must be some behind the last.
  positions.emplace_back();
  scene->positions = std::move(positions);
  scene->triangles = std::move(triangles);
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
  return Occluders(std::move(scene));
}

std::size_t Occluders::countOpen(std::span<const OcclusionRay> rays, float distance) const {
  RTCScene scene = scene_->triangle_scene.get();
  return static_cast<std::size_t>(std::count_if(
      rays.begin(), rays.end(), [&](const auto& ray) { return isOpen(scene, ray, distance); }));
}

}  // namespace galactic::bake
