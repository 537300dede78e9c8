#pragma once
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "dynamics/sources/robot_model.h"
#include "dynamics/world.h"
#include "galactic/pack.h"
#include "support/homes/small_home.h"

namespace galactic::test {

/// A robot in a pack of its own.
class MadeRobot {
 public:
  explicit MadeRobot(RobotPackFields fields)
      : bytes_([&] {
          fields.radii = {0.015F, 0.05F, 0.12F};
          return buildPack(fields);
        }()),
        pack_(std::make_unique<PackFile>(PackFile::view(bytes_.bytes(), "robot.pack").value())),
        robot_(std::make_unique<Robot>(Robot::from(*pack_).value())) {}

  [[nodiscard]] const Robot& operator*() const { return *robot_; }

 private:
  AlignedBytes bytes_;
  std::unique_ptr<PackFile> pack_;
  std::unique_ptr<Robot> robot_;
};

/// The corners of a box around `center`, meters.
inline dynamics::HullPoints boxPoints(const Vec3& center, const Vec3& half) {
  dynamics::HullPoints points;
  for (const float x : {-half.x, half.x}) {
    for (const float y : {-half.y, half.y}) {
      for (const float z : {-half.z, half.z}) points.push_back(center + Vec3{x, y, z});
    }
  }
  return points;
}

/// A box of even density.
inline dynamics::LinkPart boxPart(double mass, const Vec3& center, const Vec3& half) {
  const auto square = [](float length) { return 4.0 * static_cast<double>(length * length); };
  const double twelfth = mass / 12;
  const double x = square(half.x);
  const double y = square(half.y);
  const double z = square(half.z);
  return {.inertia =
              dynamics::Inertia{
                  .mass = mass,
                  .center = {static_cast<double>(center.x), static_cast<double>(center.y),
                             static_cast<double>(center.z)},
                  .moments = {twelfth * (y + z), twelfth * (x + z), twelfth * (x + y), 0, 0, 0}},
          .hulls = {boxPoints(center, half)}};
}

/// Masses and boxes for the robot of the small home: a base of 40 x 20 x 40 cm that stands on the
/// floor, and an arm of thin boxes along its links.
inline dynamics::RobotParts smallHomeParts() {
  dynamics::RobotParts parts;
  parts.body_of_link = {0, 1, 2, 3, 4};
  parts.links = {boxPart(30, {0, 0, 0}, {0.2F, 0.1F, 0.2F}),
                 boxPart(2, {0, 0.05F, 0}, {0.03F, 0.05F, 0.03F}),
                 boxPart(1, {0.075F, 0, 0}, {0.075F, 0.02F, 0.02F}),
                 boxPart(0.7, {0.05F, 0, 0}, {0.05F, 0.02F, 0.02F}),
                 boxPart(0.5, {0.05F, 0, 0}, {0.04F, 0.02F, 0.02F})};
  return parts;
}

/// All that a world wants of a robot.
struct RobotKit {
  RobotKit(const Robot& made, dynamics::RobotParts given)
      : robot(made),
        parts(std::move(given)),
        shape(dynamics::makeRobotShape(parts)),
        positions(made.startPositions().begin(), made.startPositions().end()),
        bodies(dynamics::bodiesOf(parts, made, positions)) {}

  [[nodiscard]] dynamics::RobotSetup setup(const Pose& world_from_root) const {
    return {.robot = robot,
            .shape = shape,
            .bodies = bodies,
            .world_from_root = world_from_root,
            .positions = positions};
  }

  const Robot& robot;
  dynamics::RobotParts parts;
  std::shared_ptr<const dynamics::RobotShape> shape;
  std::vector<float> positions;
  std::vector<dynamics::RobotBody> bodies;
};

}  // namespace galactic::test
