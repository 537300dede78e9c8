#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <span>
#include <vector>

#include "galactic/kinematics.h"

namespace galactic::test {

/// Forward kinematics once more, in double precision with matrices instead of quaternions, from the
/// words of the documentation.
struct OracleLink {
  Eigen::Isometry3d parent_from_joint = Eigen::Isometry3d::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  JointType type = JointType::kFixed;
  int parent = -1;
  /// First of the joint's values; -1: none.
  int position = -1;
  double multiplier = 1;
  double offset = 0;
};

/// Rodrigues' formula, written out.
inline Eigen::Matrix3d rotationMatrix(const Eigen::Vector3d& axis, double angle) {
  Eigen::Matrix3d cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return Eigen::Matrix3d::Identity() + std::sin(angle) * cross +
         (1 - std::cos(angle)) * cross * cross;
}

inline Eigen::Isometry3d planarMotion(const Eigen::Vector3d& axis, double along, double across,
                                      double angle) {
  // The part of X across the axis, or of Z where the axis is nearly X.
  constexpr double kNearlyX = 0.99;
  const Eigen::Vector3d start = std::abs(axis.x()) < kNearlyX
                                    ? Eigen::Vector3d(Eigen::Vector3d::UnitX())
                                    : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d first = (start - start.dot(axis) * axis).normalized();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = rotationMatrix(axis, angle);
  motion.translation() = along * first + across * axis.cross(first);
  return motion;
}

inline Eigen::Isometry3d jointMotion(const OracleLink& link, std::span<const float> positions) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  if (link.type == JointType::kFixed || link.position < 0) return motion;
  const auto at = [&](int n) {
    return static_cast<double>(positions[static_cast<std::size_t>(link.position + n)]);
  };
  const double value = link.multiplier * at(0) + link.offset;
  switch (link.type) {
    case JointType::kFixed:
      break;
    case JointType::kRevolute:
    case JointType::kContinuous:
      motion.linear() = rotationMatrix(link.axis, value);
      break;
    case JointType::kPrismatic:
      motion.translation() = value * link.axis;
      break;
    case JointType::kPlanar:
      return planarMotion(link.axis, at(0), at(1), at(2));
    case JointType::kFloating:
      motion.linear() =
          Eigen::Quaterniond(at(6), at(3), at(4), at(5)).normalized().toRotationMatrix();
      motion.translation() = Eigen::Vector3d(at(0), at(1), at(2));
      break;
  }
  return motion;
}

inline std::vector<Eigen::Isometry3d> oraclePoses(const std::vector<OracleLink>& links,
                                                  const Eigen::Isometry3d& world_from_root,
                                                  std::span<const float> positions) {
  std::vector<Eigen::Isometry3d> poses;
  for (const OracleLink& link : links) {
    const Eigen::Isometry3d& below =
        link.parent < 0 ? world_from_root : poses[static_cast<std::size_t>(link.parent)];
    poses.push_back(below * link.parent_from_joint * jointMotion(link, positions));
  }
  return poses;
}

inline Eigen::Vector3d toEigen(const Vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

inline Eigen::Quaterniond toEigen(const Quat& q) {
  return {static_cast<double>(q.w), static_cast<double>(q.x), static_cast<double>(q.y),
          static_cast<double>(q.z)};
}

inline Eigen::Isometry3d toEigen(const Pose& pose) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = toEigen(pose.rotation).normalized().toRotationMatrix();
  transform.translation() = toEigen(pose.translation);
  return transform;
}

/// The largest differences of two sets of poses.
struct PoseDifference {
  /// Meters.
  double translation = 0;
  /// Radians.
  double rotation = 0;

  void add(const Pose& pose, const Eigen::Isometry3d& wanted) {
    translation = std::max(translation, (toEigen(pose.translation) - wanted.translation()).norm());
    // From the sine and cosine of half the angle: exact for small angles too.
    const Eigen::Quaterniond turn =
        toEigen(pose.rotation).normalized().conjugate() * Eigen::Quaterniond(wanted.linear());
    rotation = std::max(rotation, 2 * std::atan2(turn.vec().norm(), std::abs(turn.w())));
  }
};

}  // namespace galactic::test
