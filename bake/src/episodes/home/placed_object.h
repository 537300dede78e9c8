#pragma once
#include <cstdint>
#include <span>

#include "episodes/home/robot_body.h"
#include "galactic/object_set.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// The outline of an object's box from above, and its heights: a rectangle that contains the
/// corners of the box. Meters.
struct Footprint {
  float x = 0;
  float z = 0;
  float half_length = 0;
  float half_width = 0;
  /// Unit vector along the length, in x and z.
  float along_x = 1;
  float along_z = 0;
  Span heights;
};

/// An object in a stable pose, turned by a yaw.
struct PlacedObject {
  const ObjectModel* model = nullptr;
  /// Index into the object set.
  std::uint32_t object = 0;
  /// world_from_object.
  Pose pose;
  Footprint footprint;
};

/// The size of a model in one of its stable poses before the yaw: the corners of its box in the
/// plane's frame, relative to the object's origin above the plane. Meters.
struct StandingSize {
  Vec3 min;
  Vec3 max;
};
[[nodiscard]] StandingSize standingSize(const ObjectModel& model, const StablePose& pose);

/// Where to put an object: with its origin above (x, z), on a surface of this height, turned by a
/// yaw.
struct Spot {
  float x = 0;
  float z = 0;
  float surface = 0;
  float yaw = 0;
};
[[nodiscard]] PlacedObject placeObject(const ObjectModel& model, std::uint32_t object,
                                       const StablePose& stable, const Spot& spot);

/// A lower bound of the distance between two placed boxes, meters: that of their footprints, or of
/// their heights if this is more; 0 or less if both overlap.
[[nodiscard]] float gapBetween(const Footprint& a, const Footprint& b);

/// Distance between a point and an object's box, meters; 0 inside.
[[nodiscard]] float distanceToBox(const PlacedObject& object, const Vec3& point);

/// Whether any sphere is closer to the object's box than its radius.
[[nodiscard]] bool touches(const PlacedObject& object, std::span<const BodySphere> spheres);

}  // namespace galactic::bake
