#include <algorithm>
#include <string>
#include <utility>

#include "engines/embree.h"
#include "engines/triangle_rays.h"
#include "support/out_of_memory.h"

namespace galactic::bake {
namespace {

// Whether a ray hits an edge depends on the instruction set, and packs are compared byte by byte.
// So this uses SSE2, which all x86-64 processors have. Other architectures only have one set.
#if defined(__x86_64__)
constexpr const char* kInstructions = "isa=sse2,";
#else
constexpr const char* kInstructions = "";
#endif

RTCRay embreeRay(const Ray& from) {
  RTCRay ray{};
  ray.org_x = from.origin.x;
  ray.org_y = from.origin.y;
  ray.org_z = from.origin.z;
  ray.dir_x = from.direction.x;
  ray.dir_y = from.direction.y;
  ray.dir_z = from.direction.z;
  ray.tnear = from.nearest;
  ray.tfar = from.farthest;
  ray.mask = ~0U;
  return ray;
}

}  // namespace

struct TriangleRays::Scene {
  EmbreeDevice device;
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  EmbreeScene scene;
};

TriangleRays::TriangleRays(std::unique_ptr<Scene> scene) : scene_(std::move(scene)) {}
TriangleRays::~TriangleRays() = default;
TriangleRays::TriangleRays(TriangleRays&& other) noexcept = default;
TriangleRays& TriangleRays::operator=(TriangleRays&& other) noexcept = default;

std::optional<TriangleRays> TriangleRays::build(std::vector<Vec3> positions,
                                                std::vector<Triangle> triangles, unsigned threads) {
  // Embree terminates the program if memory runs out while it starts its threads, so it is not
  // started with less than this. Bytes.
  constexpr double kToBegin = 160e6;
  if (!checkMemory(kToBegin, "rays", {})) return std::nullopt;
  auto built = std::make_unique<Scene>();
  const std::string settings = kInstructions + ("threads=" + std::to_string(std::max(1U, threads)));
  built->device.reset(rtcNewDevice(settings.c_str()));
  RTCDevice device = built->device.get();
  if (device == nullptr) return std::nullopt;
  const std::size_t count = positions.size();
  // Embree reads 16 bytes per position, so there must be more after the last one.
  positions.emplace_back();
  built->positions = std::move(positions);
  built->triangles = std::move(triangles);
  built->scene.reset(rtcNewScene(device));
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  if (!built->scene || geometry == nullptr) return std::nullopt;
  rtcSetSceneFlags(built->scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             built->positions.data(), 0, sizeof(Vec3), count);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             built->triangles.data(), 0, sizeof(Triangle), built->triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(built->scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(built->scene.get());
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) return std::nullopt;
  return TriangleRays(std::move(built));
}

std::optional<float> TriangleRays::first(const Ray& ray) const {
  RTCRayHit hit{};
  hit.ray = embreeRay(ray);
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(scene_->scene.get(), &hit);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_->scene.get(), &context, &hit);
#endif
  if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return hit.ray.tfar;
}

bool TriangleRays::isOpen(const Ray& ray) const {
  RTCRay traced = embreeRay(ray);
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded1(scene_->scene.get(), &traced);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene_->scene.get(), &context, &traced);
#endif
  // Embree marks an occluded ray with a negative length.
  return traced.tfar >= 0;
}

}  // namespace galactic::bake
