#pragma once
// Only for the files that name Bullet.
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "bullet_memory.h"
#include "galactic/bake/triangle_mesh.h"

namespace galactic::bake {

static_assert(sizeof(Vec3) == 3 * sizeof(float) && sizeof(Triangle) == 3 * sizeof(int));

/// A mesh with its tree as Bullet wants it. Immutable once built, so many casters may share it.
class BulletMesh {
 public:
  explicit BulletMesh(const TriangleMesh& mesh)
      : vertices_(mesh.vertices), triangles_(mesh.triangles) {
    for (std::size_t first = 0; first < triangles_.size(); first += kTrianglesPerPart) {
      btIndexedMesh part;
      part.m_numTriangles =
          static_cast<int>(std::min(kTrianglesPerPart, triangles_.size() - first));
      part.m_triangleIndexBase =
          reinterpret_cast<const unsigned char*>(triangles_.data() + first);  // as Bullet asks
      part.m_triangleIndexStride = sizeof(Triangle);
      part.m_numVertices = static_cast<int>(vertices_.size());
      part.m_vertexBase = reinterpret_cast<const unsigned char*>(vertices_.data());
      part.m_vertexStride = sizeof(Vec3);
      part.m_vertexType = PHY_FLOAT;
      arrays_.addIndexedMesh(part, PHY_INTEGER);
    }
    constexpr bool kQuantized = true;
    shape_ = std::make_unique<btBvhTriangleMeshShape>(&arrays_, kQuantized);
    // Bullet's default of 4 cm would grow every surface.
    shape_->setMargin(0);
  }
  BulletMesh(const BulletMesh&) = delete;
  BulletMesh& operator=(const BulletMesh&) = delete;

  /// Returns a mutable shape because Bullet asks for one even where it only reads.
  [[nodiscard]] btBvhTriangleMeshShape* get() const { return shape_.get(); }

 private:
  /// Bullet's quantized tree keeps a triangle's index in 21 bits: bigger meshes go in as several
  /// parts.
  static constexpr std::size_t kTrianglesPerPart = std::size_t{1} << 20U;

  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
  btTriangleIndexVertexArray arrays_;
  std::unique_ptr<btBvhTriangleMeshShape> shape_;
};

}  // namespace galactic::bake
