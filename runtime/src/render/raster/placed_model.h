#pragma once
#include "galactic/pose.h"
#include "render/raster/pane_task.h"

// Turns poses into what rasterizers read. This code runs on processors and on graphics processors,
// so it does without the standard library.
namespace galactic::render {

GALACTIC_EVERYWHERE inline bool isFinite(const Vec3& v) {
  return v.x - v.x == 0 && v.y - v.y == 0 && v.z - v.z == 0;
}

GALACTIC_EVERYWHERE inline bool isFinite(const RigidTransform& t) {
  return isFinite(t.x_axis) && isFinite(t.y_axis) && isFinite(t.z_axis) && isFinite(t.origin);
}

/// Computes the rows of a placed model; returns false if a number overflows. `focal`: see
/// focalLength(). The camera looks along its x axis; y is up, z to the right.
GALACTIC_EVERYWHERE inline bool placeModel(const RigidTransform& camera_from_world, float focal,
                                           const RigidTransform& world_from_model,
                                           PlacedModel& placed) {
  const RigidTransform t = camera_from_world * world_from_model;
  const RigidTransform scaled{t.x_axis * focal, t.y_axis * focal, t.z_axis * focal,
                              t.origin * focal};
  if (!isFinite(t) || !isFinite(scaled)) return false;
  placed.w[0] = t.x_axis.x;
  placed.w[1] = t.y_axis.x;
  placed.w[2] = t.z_axis.x;
  placed.w[3] = t.origin.x;
  placed.x[0] = scaled.x_axis.z;
  placed.x[1] = scaled.y_axis.z;
  placed.x[2] = scaled.z_axis.z;
  placed.x[3] = scaled.origin.z;
  placed.y[0] = -scaled.x_axis.y;
  placed.y[1] = -scaled.y_axis.y;
  placed.y[2] = -scaled.z_axis.y;
  placed.y[3] = -scaled.origin.y;
  return true;
}

}  // namespace galactic::render
