#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "galactic/shapes.h"
#include "support/packs/pack_parts.h"
#include "support/packs/render_pack_builder.h"

namespace galactic::test {

struct BoxVolumeFields {
  double volume = 0.001;
  double axis_aligned = 0.002;
  double pca = 0.0015;
};

struct BoundsFields {
  Vec3 min{-0.1F, 0, -0.1F};
  Vec3 max{0.1F, 0.2F, 0.1F};
};

/// One object of a pack.
struct ObjectFields {
  std::string name = "mug";
  std::optional<Pose> box_pose = Pose{{0, 0.1F, 0}, {0, 0, 0, 1}};
  std::optional<Vec3> box_half_extents = Vec3{0.1F, 0.1F, 0.1F};
  std::uint8_t box_fit = 0;
  std::optional<BoxVolumeFields> box_statistics = BoxVolumeFields{};
  std::vector<SetSphere> spheres{
      {{0, 0.1F, 0}, 1}, {{-0.05F, 0.05F, 0}, 0}, {{0.05F, 0.05F, 0}, 0}, {{0.05F, 0.06F, 0}, 0}};
  SphereStatisticsFields statistics;
  std::vector<StablePose> stable_poses{{{0, 0, 0, 1}, 0, 0.75F}, {{1, 0, 0, 0}, 0.2F, 0.25F}};
  std::optional<BoundsFields> bounds = BoundsFields{};
  /// None: the pack of an older program.
  std::optional<std::vector<HullPlane>> hull_planes;
  std::string format = "Wavefront OBJ";
  std::uint64_t triangles_read = 6;
  std::uint64_t triangles_degenerate = 1;
  std::uint64_t triangles = 5;
  SurfaceFields surface;
};

/// All that an object pack holds. buildPack makes a pack that is valid in every field that was left
/// as it is.
struct ObjectPackFields {
  PackKind kind = PackKind::kObjects;
  std::vector<float> radii{0.015F, 0.05F};
  std::vector<ObjectFields> objects;
  RenderMeshesField render_meshes;
};

/// Two objects; the second one without colors, with one sphere and one pose.
ObjectPackFields smallObjects();

/// The whole file: header and payload.
AlignedBytes buildPack(const ObjectPackFields& fields);

}  // namespace galactic::test
