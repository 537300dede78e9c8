#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/sources/hull_points.h"
#include "galactic/bake/robot_import.h"
#include "galactic/bake/source_robot.h"
#include "galactic/error.h"
#include "galactic/kinematics.h"
#include "galactic/pose.h"
#include "galactic/robot.h"

namespace galactic::dynamics {

/// What resists being moved: mass, center of mass and moments of inertia about it.
struct Inertia {
  /// Kilograms.
  double mass = 0;
  /// In the frame of the link or body, meters.
  std::array<double, 3> center{};
  /// xx, yy, zz, xy, xz, yz about the center, along the axes of that frame; kg m^2.
  std::array<double, 6> moments{};
};

/// What a link is made of, in its frame.
struct LinkPart {
  /// None: a bare frame.
  std::optional<Inertia> inertia;
  std::vector<HullPoints> hulls;
};

/// The links of a robot with their masses and shapes, and which of them are one rigid body.
struct RobotParts {
  /// One per link of the pack.
  std::vector<LinkPart> links;
  /// The body of each link: 0 is the base; what no action moves belongs to its parent's body.
  std::vector<std::uint32_t> body_of_link;
  /// What was missing or impossible and what is taken instead, one sentence each.
  std::vector<std::string> warnings;
};

/// What stands in for what a robot's file does not say.
struct RobotDefaults {
  /// Of a link with a shape and without a mass, spread over the box around its shape; kg/m^3.
  double density = 300;
  /// The least that it gets; also the mass of a body whose links have neither mass nor shape, which
  /// is then a cube of `least_size` meters. Kilograms.
  double least_mass = 0.1;
  double least_size = 0.05;
};

/// A robot's file: what a bake reads of it, and its masses (Z up).
struct RobotSource {
  /// Its name, for warnings.
  std::string file;
  bake::SourceRobot robot;
  std::vector<bake::LinkInertial> inertials;
};

/// Matches the links of a pack with those of the file by their names. Shapes are the convex hulls
/// of each collision element (of the visuals where a link has none), one per mesh in its file.
///
/// An <inertial> counts when its numbers can be those of a body (body_ranges.h), and none of its
/// principal moments is greater than the sum of the other two. Else the mass is that of `defaults`,
/// or the center or the moments are those of the box around the shape, and there is a warning.
/// Fails with kInvalidInput where the file has no link of a name in the pack.
[[nodiscard]] Result<RobotParts> robotParts(const RobotSource& source, const Robot& robot,
                                            const RobotDefaults& defaults = {});

/// A link as a piece of its body.
struct BodyLink {
  std::uint32_t link = 0;
  Pose body_from_link;
};

/// Links that nothing moves against each other in a run, in the frame of the first of them.
struct RobotBody {
  /// That first link, whose joint carries the body: the root for body 0.
  std::uint32_t link = 0;
  /// Index of the body that it hangs from, smaller than its own; -1 for the base.
  int parent = -1;
  /// Of the joint, in the frame of the parent body.
  Pose parent_from_joint;
  Inertia inertia;
  std::vector<BodyLink> links;
};

/// The bodies of a robot whose unmoved joints are held in `positions` (one per position of the
/// robot, radians or meters). Base first, parents before children.
[[nodiscard]] std::vector<RobotBody> bodiesOf(const RobotParts& parts, const Robot& robot,
                                              std::span<const float> positions);

}  // namespace galactic::dynamics
