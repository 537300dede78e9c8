#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>

#include <map>
#include <utility>

#include "dynamics/bullet/contact_query.h"
#include "dynamics/bullet/rig.h"
#include "dynamics/bullet/shapes.h"

namespace galactic::dynamics {

class ContactProbe::Impl {
 public:
  Impl(std::shared_ptr<const SceneShape> scene, std::span<const PlacedObject> objects,
       const RobotSetup& setup)
      : robot_(setup.robot),
        scene_(std::move(scene)),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &configuration_),
        world_from_link_(setup.robot.links().size()) {
    add(ground_, scene_->get(), btTransform::getIdentity(), kSceneBit);
    for (const PlacedObject& object : objects) {
      shapes_.push_back(object.shape);
      objects_.push_back(std::make_unique<btCollisionObject>());
      add(*objects_.back(), object.shape->get(),
          toBullet(object.world_from_object) * object.shape->inertia().body_from_inertia,
          kObjectBit);
    }
    for (const RobotBody& body : setup.bodies) {
      Ghost& ghost = ghosts_.emplace_back();
      ghost.link = body.link;
      ghost.compound = setup.shape->compound(body, btTransform::getIdentity());
      ghost.link_of_child = setup.shape->linksOfChildren(body);
      ghost.object = std::make_unique<btCollisionObject>();
      ghost.object->setCollisionShape(ghost.compound.get());
    }
  }
  ~Impl() {
    for (const auto& object : objects_) world_.removeCollisionObject(object.get());
    world_.removeCollisionObject(&ground_);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  Impl(Impl&&) = delete;
  Impl& operator=(Impl&&) = delete;

  void moveObject(std::size_t n, const Pose& world_from_object) {
    objects_[n]->setWorldTransform(toBullet(world_from_object) *
                                   shapes_[n]->inertia().body_from_inertia);
    world_.updateSingleAabb(objects_[n].get());
  }

  [[nodiscard]] std::vector<RobotContact> contacts(const Pose& world_from_root,
                                                   std::span<const float> positions,
                                                   std::optional<std::size_t> ignored) {
    forwardKinematics(robot_.links(), world_from_root, positions, world_from_link_);
    std::map<std::pair<std::uint32_t, std::int32_t>, RobotContact> deepest;
    for (const Ghost& ghost : ghosts_) {
      ghost.object->setWorldTransform(toBullet(world_from_link_[ghost.link]));
      ContactQuery query(*ghost.object, kSceneBit | kObjectBit, [&](const QueryContact& contact) {
        const int other = contact.other->getUserIndex();
        if (!(contact.depth > 0) || (ignored && other == static_cast<int>(*ignored))) return;
        const std::uint32_t link = ghost.link_of_child[static_cast<std::size_t>(contact.child)];
        RobotContact& kept = deepest[{link, other}];
        if (contact.depth > kept.depth) {
          kept = {link,
                  other,
                  contact.depth,
                  fromBullet(contact.point),
                  fromBullet(contact.away),
                  fromBullet(contact.on_object)};
        }
      });
      world_.contactTest(ghost.object.get(), query);
    }
    std::vector<RobotContact> contacts;
    contacts.reserve(deepest.size());
    for (const auto& [key, contact] : deepest) contacts.push_back(contact);
    return contacts;
  }

 private:
  /// A body of the robot, which is not in a world.
  struct Ghost {
    std::uint32_t link = 0;
    std::unique_ptr<btCompoundShape> compound;
    std::vector<std::uint32_t> link_of_child;
    std::unique_ptr<btCollisionObject> object;
  };

  void add(btCollisionObject& object, btCollisionShape* shape, const btTransform& at, int bit) {
    object.setCollisionShape(shape);
    object.setWorldTransform(at);
    object.setUserIndex(bit == kSceneBit ? -1 : static_cast<int>(objects_.size()) - 1);
    // Objects collide with nothing; contacts are found only by queries.
    world_.addCollisionObject(&object, bit, 0);
  }

  const Robot& robot_;
  std::shared_ptr<const SceneShape> scene_;
  std::vector<std::shared_ptr<const ObjectShape>> shapes_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_;
  btCollisionObject ground_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
  std::vector<Ghost> ghosts_;
  std::vector<Pose> world_from_link_;
};

ContactProbe::ContactProbe(std::shared_ptr<const SceneShape> scene,
                           std::span<const PlacedObject> objects, const RobotSetup& setup)
    : impl_(std::make_unique<Impl>(std::move(scene), objects, setup)) {}
ContactProbe::~ContactProbe() = default;
ContactProbe::ContactProbe(ContactProbe&&) noexcept = default;

void ContactProbe::moveObject(std::size_t object, const Pose& world_from_object) {
  impl_->moveObject(object, world_from_object);
}
std::vector<RobotContact> ContactProbe::contacts(const Pose& world_from_root,
                                                 std::span<const float> positions,
                                                 std::optional<std::size_t> ignored) const {
  return impl_->contacts(world_from_root, positions, ignored);
}

}  // namespace galactic::dynamics
