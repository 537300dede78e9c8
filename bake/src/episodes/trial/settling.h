#pragma once
#include <memory>
#include <span>
#include <vector>

#include "galactic/bake/triangle_mesh.h"
#include "galactic/object_set.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// The convex shape of an object for settling.
struct SettlingBody {
  /// object_from_body: the body's origin is its center of mass.
  Pose object_from_body;
  /// Corners of the hull in the frame of the body, meters; empty for a box.
  std::vector<Vec3> corners;
  /// Half extents of the box, meters; not used if there are corners.
  Vec3 half_extents;
};

/// The box of an object, with uniform density.
[[nodiscard]] SettlingBody boxBody(const ObjectModel& model);

/// The convex hull of points in the object's frame (meters), with uniform density; the box of
/// `model` if the points enclose no volume.
[[nodiscard]] SettlingBody hullBody(std::span<const Vec3> points, const ObjectModel& model);

/// What happened to an object that was let go.
enum class SettlingEnd {
  kRests,   ///< It came to rest about where it was.
  kMoved,   ///< It moved further than kSettlingWay, or did not come to rest.
  kTipped,  ///< It leans by more than kSettlingLean.
};

struct Settled {
  SettlingEnd end = SettlingEnd::kRests;
  /// world_from_object.
  Pose pose;
};

/// How far a settled object may have moved (meters) and leaned over (radians).
inline constexpr float kSettlingWay = 0.01F;
inline constexpr float kSettlingLean = 0.0873F;

/// The triangles of a scene onto which objects are dropped, one at a time. Implemented with Bullet,
/// in bullet_settling.cpp.
class SettlingScene {
 public:
  /// Copies what it needs.
  explicit SettlingScene(const TriangleMesh& mesh);
  ~SettlingScene();
  SettlingScene(SettlingScene&&) noexcept;
  SettlingScene& operator=(SettlingScene&&) noexcept;
  SettlingScene(const SettlingScene&) = delete;
  SettlingScene& operator=(const SettlingScene&) = delete;

  /// Lets the object go slightly above `world_from_object`, in a world of its own: earlier calls
  /// leave no trace, and the result depends only on the arguments. Takes steps of fixed length, for
  /// at most two seconds. Thread-safe.
  [[nodiscard]] Settled settle(const SettlingBody& body, const Pose& world_from_object) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace galactic::bake
