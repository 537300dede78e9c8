// The only file that names Bullet's collision worlds for casts.
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include "engines/bullet_mesh.h"
#include "engines/columns_by_rows.h"
#include "galactic/bake/column_engines.h"

namespace galactic::bake {
namespace {

/// Pools for one pair of objects at a time; Bullet's defaults are megabytes.
btDefaultCollisionConstructionInfo smallPools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 16;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 16;
  return info;
}

/// Records whether there was any contact.
struct AnyContact : btCollisionWorld::ContactResultCallback {
  bool found = false;

  // NOLINTNEXTLINE(readability-function-size): the signature is Bullet's.
  btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    found = true;
    return 0;
  }
};

btTransform placedAt(const btVector3& center) {
  return btTransform(btQuaternion::getIdentity(), center);
}

/// One collision object, and what Bullet needs to test spheres against it. Not thread-safe.
class SphereProbe {
 public:
  SphereProbe(std::shared_ptr<const BulletMesh> shape, const BulletCastOptions& options)
      : options_(options),
        shape_(std::move(shape)),
        configuration_(smallPools()),
        dispatcher_(&configuration_),
        collision_world_(&dispatcher_, &broadphase_, &configuration_) {
    mesh_object_.setCollisionShape(shape_->get());
  }

  [[nodiscard]] const BulletCastOptions& options() const { return options_; }
  [[nodiscard]] const std::shared_ptr<const BulletMesh>& shape() const { return shape_; }

  /// Whether a ball of `radius` at `center` touches the mesh according to Bullet, which counts
  /// contacts up to 2 % of the radius away.
  [[nodiscard]] bool overlaps(const btVector3& center, float radius) {
    btSphereShape sphere(radius);
    btCollisionObject object;
    object.setCollisionShape(&sphere);
    object.setWorldTransform(placedAt(center));
    AnyContact contact;
    // Does not add the ball to the world, which gives the same contacts with less bookkeeping.
    collision_world_.contactPairTest(&object, &mesh_object_, contact);
    return contact.found;
  }

  /// Where a moving ball first touches the mesh.
  struct Hit {
    float distance = 0;
    /// Height of the point touched.
    float height = 0;
  };

  /// Moves a ball of `radius` from `from` to `to`, which is above or below `from`.
  [[nodiscard]] std::optional<Hit> sweep(const btVector3& from, const btVector3& to, float radius) {
    const btSphereShape sphere(radius);
    btCollisionWorld::ClosestConvexResultCallback closest(from, to);
    btCollisionWorld::objectQuerySingle(&sphere, placedAt(from), placedAt(to), &mesh_object_,
                                        shape_->get(), mesh_object_.getWorldTransform(), closest,
                                        0);
    if (!closest.hasHit()) return std::nullopt;
    return Hit{closest.m_closestHitFraction * (to - from).length(), closest.m_hitPointWorld.y()};
  }

 private:
  BulletCastOptions options_;
  std::shared_ptr<const BulletMesh> shape_;
  btCollisionObject mesh_object_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btCollisionWorld collision_world_;
};

/// Searches one column from bottom to top: the published search (paper, appendix G, and its code),
/// at the centers of our columns.
class ColumnSearch {
 public:
  ColumnSearch(SphereProbe& probe, const GridFrame& frame, ColumnIndex at)
      : sphere_(probe),
        x_(static_cast<float>(frame.centerX(at.i))),
        z_(static_cast<float>(frame.centerZ(at.k))),
        radius_(frame.radius),
        heights_(frame.heights),
        probe_(frame.heights.lo),
        top_(frame.heights.lo) {}

  std::vector<Span> run() {
    if (isClear(probe_)) {
      open_ = probe_;
    } else {
      probe_ += sphere_.options().step;
    }
    while (!finished_) {
      if (open_) sweepUp();
      if (!finished_) leaveObstacle();
    }
    return std::move(spans_);
  }

 private:
  [[nodiscard]] btVector3 center(float height) const { return {x_, height, z_}; }

  [[nodiscard]] bool isClear(float height) {
    return !sphere_.overlaps(center(height), radius_ + sphere_.options().contact_pad);
  }

  /// Starts at a clear probe. The open span ends where a ball moving up touches something, or at
  /// the top.
  void sweepUp() {
    const auto hit = sphere_.sweep(center(probe_), center(heights_.hi), radius_);
    if (!hit) {
      top_ = heights_.hi;
      store();
      finished_ = true;
      return;
    }
    top_ = probe_ + hit->distance;
    // At least one step up, whatever the cast returns, so that the search ends.
    probe_ = std::max(probe_, hit->height) + sphere_.options().step;
  }

  /// Steps up until the ball is clear, then casts down to find the obstacle's upper side.
  void leaveObstacle() {
    while (probe_ < heights_.hi) {
      if (!isClear(probe_)) {
        probe_ += sphere_.options().step;
        continue;
      }
      const auto hit = sphere_.sweep(center(probe_), center(top_), radius_);
      // The published code reads the first hit before it checks whether there is one, which is
      // undefined behavior without hits. Checking first does what it intends.
      if (!hit) {
        // A grazing obstacle that only one of the casts hits is ignored, and the span continues.
        if (!open_) open_ = heights_.lo;
        return;
      }
      if (hit->distance > 0) {
        if (open_) store();
        open_ = std::max(probe_ - hit->distance, top_);
        return;
      }
      probe_ += sphere_.options().step;
    }
    if (open_) store();
    finished_ = true;
  }

  void store() {
    if (top_ - *open_ > kMergeTolerance) spans_.push_back({*open_, top_});
  }

  SphereProbe& sphere_;
  float x_;
  float z_;
  float radius_;
  Span heights_;
  /// Height of the ball.
  float probe_;
  /// Top of the open span, or the lower end of the heights if there is none. The obstacle above
  /// cannot reach farther down.
  float top_;
  /// Bottom of the open span.
  std::optional<float> open_;
  bool finished_ = false;
  std::vector<Span> spans_;
};

}  // namespace

class BulletColumnCaster::World : public SphereProbe {
  using SphereProbe::SphereProbe;
};

BulletColumnCaster::BulletColumnCaster(const TriangleMesh& mesh, const BulletCastOptions& options)
    : world_(std::make_unique<World>(std::make_shared<const BulletMesh>(mesh), options)) {}
BulletColumnCaster::BulletColumnCaster(std::unique_ptr<World> world) : world_(std::move(world)) {}
BulletColumnCaster::~BulletColumnCaster() = default;
BulletColumnCaster::BulletColumnCaster(BulletColumnCaster&&) noexcept = default;
BulletColumnCaster& BulletColumnCaster::operator=(BulletColumnCaster&&) noexcept = default;

BulletColumnCaster BulletColumnCaster::another() const {
  return BulletColumnCaster(std::make_unique<World>(world_->shape(), world_->options()));
}

std::vector<Span> BulletColumnCaster::column(const GridFrame& frame, ColumnIndex at) const {
  return ColumnSearch(*world_, frame, at).run();
}

Columns bulletColumns(const TriangleMesh& mesh, const GridFrame& frame, unsigned threads) {
  const auto shape = std::make_shared<const BulletMesh>(mesh);
  return columnsByRows(frame, threads, [&](std::uint32_t row) {
    SphereProbe probe(shape, {});
    RowSpans result;
    for (std::uint32_t i = 0; i < frame.columns_x; ++i) {
      const std::vector<Span> spans = ColumnSearch(probe, frame, {i, row}).run();
      result.counts.push_back(static_cast<std::uint32_t>(spans.size()));
      result.spans.insert(result.spans.end(), spans.begin(), spans.end());
    }
    return result;
  });
}

}  // namespace galactic::bake
