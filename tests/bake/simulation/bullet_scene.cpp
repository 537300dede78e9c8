#include "bullet_scene.h"

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>

namespace galactic::test {
namespace {

btVector3 toBullet(const Vec3& v) { return {v.x, v.y, v.z}; }

btDefaultCollisionConstructionInfo smallPools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 16;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 16;
  return info;
}

/// Remembers whether there was any contact.
struct AnyContact : btCollisionWorld::ContactResultCallback {
  bool found = false;

  // NOLINTNEXTLINE(readability-function-size): the signature is Bullet's.
  btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    found = true;
    return 0;
  }
};

}  // namespace

class BulletScene::Impl {
 public:
  explicit Impl(const bake::TriangleMesh& mesh)
      : configuration_(smallPools()),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &configuration_) {
    for (const bake::Triangle& triangle : mesh.triangles) {
      triangles_.addTriangle(toBullet(mesh.vertices[triangle[0]]),
                             toBullet(mesh.vertices[triangle[1]]),
                             toBullet(mesh.vertices[triangle[2]]));
    }
    constexpr bool kQuantized = false;
    shape_ = std::make_unique<btBvhTriangleMeshShape>(&triangles_, kQuantized);
    // Bullet's default of 4 cm would grow every surface.
    shape_->setMargin(0);
    object_.setCollisionShape(shape_.get());
  }

  bool crosses(const Vec3& from, const Vec3& to, float radius) {
    const btTransform start(btQuaternion::getIdentity(), toBullet(from));
    const btTransform end(btQuaternion::getIdentity(), toBullet(to));
    if (radius <= 0) {
      btCollisionWorld::ClosestRayResultCallback hit(start.getOrigin(), end.getOrigin());
      btCollisionWorld::rayTestSingle(start, end, &object_, shape_.get(),
                                      object_.getWorldTransform(), hit);
      return hit.hasHit();
    }
    const btSphereShape sphere(radius);
    btCollisionWorld::ClosestConvexResultCallback hit(start.getOrigin(), end.getOrigin());
    btCollisionWorld::objectQuerySingle(&sphere, start, end, &object_, shape_.get(),
                                        object_.getWorldTransform(), hit, 0);
    return hit.hasHit();
  }

  bool touches(const Vec3& center, float radius) {
    btSphereShape sphere(radius);
    btCollisionObject ball;
    ball.setCollisionShape(&sphere);
    ball.setWorldTransform(btTransform(btQuaternion::getIdentity(), toBullet(center)));
    AnyContact contact;
    world_.contactPairTest(&ball, &object_, contact);
    return contact.found;
  }

 private:
  btTriangleMesh triangles_;
  std::unique_ptr<btBvhTriangleMeshShape> shape_;
  btCollisionObject object_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_;
};

BulletScene::BulletScene(const bake::TriangleMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}
BulletScene::~BulletScene() = default;

bool BulletScene::touches(const Vec3& center, float radius) {
  return impl_->touches(center, radius);
}

bool BulletScene::crosses(const Vec3& from, const Vec3& to, float radius) {
  return impl_->crosses(from, to, radius);
}

}  // namespace galactic::test
