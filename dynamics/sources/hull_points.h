#pragma once
#include <span>
#include <string>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/bake/source_robot.h"
#include "galactic/error.h"
#include "galactic/pose.h"

namespace galactic::dynamics {

/// Points of which a convex piece is the hull, meters.
using HullPoints = std::vector<Vec3>;

/// The corners of an asset's triangles, all meshes together, in its world frame; each vertex once
/// for each mesh that is placed. Vertices that no triangle uses are no part of the surface: files
/// hold stray ones, which importers do not check.
[[nodiscard]] HullPoints cornersOf(const bake::SourceAsset& asset);

/// The corners of an asset of convex pieces: each mesh that is placed is one, or all together are
/// with `is_joined`. Leaves out those that have fewer than four corners, so there may be none.
[[nodiscard]] std::vector<HullPoints> piecesOf(const bake::SourceAsset& asset, bool is_joined);

/// The points of which a link's shapes are the hulls, in the link's frame: of its collision
/// elements, or of its visuals where it has none. Meshes of robots lie in source.meshes.
[[nodiscard]] std::vector<HullPoints> hullPointsOf(const bake::SourceRobot& source,
                                                   const bake::SourceLink& link);

/// Fails with kInvalidInput where a point is farther than bake::kMaxCoordinate from the origin
/// along an axis, or no number. `where`: whose points they are.
[[nodiscard]] Result<void> checkExtents(std::span<const HullPoints> hulls,
                                        const std::string& where);

}  // namespace galactic::dynamics
