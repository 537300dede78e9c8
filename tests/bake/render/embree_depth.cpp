#include "bake/render/embree_depth.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace galactic::test {

struct EmbreeDepth::Scene {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  ~Scene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

EmbreeDepth::EmbreeDepth(const bake::TriangleMesh& mesh) : scene_(std::make_unique<Scene>()) {
  scene_->device = rtcNewDevice("threads=1");
  scene_->scene = rtcNewScene(scene_->device);
  const RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSceneFlags(scene_->scene, RTC_SCENE_FLAG_ROBUST);
  void* positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                            sizeof(Vec3), mesh.vertices.size());
  void* corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          sizeof(bake::Triangle), mesh.triangles.size());
  if (positions == nullptr || corners == nullptr) throw std::runtime_error("Embree has no memory");
  std::memcpy(positions, mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3));
  std::memcpy(corners, mesh.triangles.data(), mesh.triangles.size() * sizeof(bake::Triangle));
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_->scene);
}

EmbreeDepth::~EmbreeDepth() = default;

float EmbreeDepth::first(const Vec3& origin, const Vec3& direction, float near) const {
  RTCRayHit hit{};
  hit.ray.org_x = origin.x;
  hit.ray.org_y = origin.y;
  hit.ray.org_z = origin.z;
  hit.ray.dir_x = direction.x;
  hit.ray.dir_y = direction.y;
  hit.ray.dir_z = direction.z;
  hit.ray.tnear = near;
  hit.ray.tfar = std::numeric_limits<float>::infinity();
  hit.ray.mask = ~0U;
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(scene_->scene, &hit);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_->scene, &context, &hit);
#endif
  return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? 0 : hit.ray.tfar;
}

std::vector<float> EmbreeDepth::image(const RenderCamera& camera,
                                      const RenderOptions& options) const {
  const RigidTransform& frame = camera.world_from_camera;
  const float up = std::tan(camera.vertical_fov / 2);
  const float side = up * static_cast<float>(options.width) / static_cast<float>(options.height);
  std::vector<float> depths;
  depths.reserve(std::size_t{options.width} * options.height);
  for (std::uint32_t row = 0; row < options.height; ++row) {
    for (std::uint32_t column = 0; column < options.width; ++column) {
      const float right =
          side * (2 * (static_cast<float>(column) + 0.5F) / static_cast<float>(options.width) - 1);
      const float above =
          up * (1 - 2 * (static_cast<float>(row) + 0.5F) / static_cast<float>(options.height));
      // One metre along the axis, so that distances along the ray are depths.
      const Vec3 direction = frame.x_axis + frame.y_axis * above + frame.z_axis * right;
      depths.push_back(first(frame.origin, direction, options.near));
    }
  }
  return depths;
}

}  // namespace galactic::test
