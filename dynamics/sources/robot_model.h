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

/// Mass, center of mass and moments of inertia about it.
struct Inertia {
  /// Kilograms.
  double mass = 0;
  /// In the frame of the link or body, meters.
  std::array<double, 3> center{};
  /// xx, yy, zz, xy, xz, yz about the center, along the axes of that frame; kg m^2.
  std::array<double, 6> moments{};
};

/// Inertia and shape of a link, in its frame.
struct LinkPart {
  /// None for a bare frame.
  std::optional<Inertia> inertia;
  std::vector<HullPoints> hulls;
};

/// The links of a robot with their masses and shapes, and how they form rigid bodies.
struct RobotParts {
  /// One per link of the pack.
  std::vector<LinkPart> links;
  /// The body of each link; 0 is the base. A link whose joint no action moves belongs to its
  /// parent's body.
  std::vector<std::uint32_t> body_of_link;
  /// One sentence for each value that was missing or impossible, with its substitute.
  std::vector<std::string> warnings;
};

/// Substitutes for values that a robot's file does not give.
struct RobotDefaults {
  /// For links with a shape but without a mass: density of the box around the shape, kg/m^3.
  double density = 300;
  /// The smallest mass of such a link, kilograms. Also the mass of a body whose links have neither
  /// mass nor shape, which becomes a cube of `least_size` meters.
  double least_mass = 0.1;
  double least_size = 0.05;
};

/// A robot's file: what a bake reads from it, and its masses (Z up).
struct RobotSource {
  /// The file's name, for warnings.
  std::string file;
  bake::SourceRobot robot;
  std::vector<bake::LinkInertial> inertials;
};

/// Matches the links of a pack with those of the file by name. Shapes are the convex hulls of each
/// collision element (of the visuals if a link has none), one per mesh in its file.
///
/// An <inertial> is used if its numbers are possible for a body (body_ranges.h), and no principal
/// moment is greater than the sum of the other two. Otherwise the mass is that of `defaults`, or
/// the center or the moments are those of the box around the shape, and there is a warning. Fails
/// with kInvalidInput if the file lacks a link of the pack.
[[nodiscard]] Result<RobotParts> robotParts(const RobotSource& source, const Robot& robot,
                                            const RobotDefaults& defaults = {});

/// A link as a part of its body.
struct BodyLink {
  std::uint32_t link = 0;
  Pose body_from_link;
};

/// Links that do not move relative to each other, in the frame of the first of them.
struct RobotBody {
  /// The first link, whose joint carries the body; the root for body 0.
  std::uint32_t link = 0;
  /// Index of the parent body, smaller than the body's own; -1 for the base.
  int parent = -1;
  /// The pose of the joint in the frame of the parent body.
  Pose parent_from_joint;
  Inertia inertia;
  std::vector<BodyLink> links;
};

/// The bodies of a robot. Joints that actions do not move are fixed at `positions` (one per
/// position of the robot, radians or meters). The base comes first, and parents before children.
[[nodiscard]] std::vector<RobotBody> bodiesOf(const RobotParts& parts, const Robot& robot,
                                              std::span<const float> positions);

}  // namespace galactic::dynamics
