#pragma once
#include <span>
#include <string>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/bake/source_robot.h"
#include "galactic/error.h"
#include "galactic/pose.h"

namespace galactic::dynamics {

/// Points whose convex hull is a piece of a shape, meters.
using HullPoints = std::vector<Vec3>;

/// The corners of an asset's triangles, of all meshes together, in the asset's world frame. Each
/// vertex appears once per placed mesh. Stray vertices that no triangle uses are left out;
/// importers do not check for them.
[[nodiscard]] HullPoints cornersOf(const bake::SourceAsset& asset);

/// The corners of an asset made of convex pieces: each placed mesh is a piece, or with `is_joined`,
/// all of them together. Pieces with fewer than four corners are left out, so the result may be
/// empty.
[[nodiscard]] std::vector<HullPoints> piecesOf(const bake::SourceAsset& asset, bool is_joined);

/// The points whose hulls are a link's shapes, in the link's frame: from its collision elements, or
/// from its visuals if it has none. The robot's meshes are in source.meshes.
[[nodiscard]] std::vector<HullPoints> hullPointsOf(const bake::SourceRobot& source,
                                                   const bake::SourceLink& link);

/// Fails with kInvalidInput if a coordinate of a point is larger than bake::kMaxCoordinate in
/// magnitude, or not a number. `where`: what the points belong to, for the message.
[[nodiscard]] Result<void> checkExtents(std::span<const HullPoints> hulls,
                                        const std::string& where);

}  // namespace galactic::dynamics
