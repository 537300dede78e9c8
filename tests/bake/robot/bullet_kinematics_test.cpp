// Forward kinematics of every robot in the assets against two independent computations: a chain of
// double matrices from the imported robot, and Bullet's multibody.
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "galactic/bake/robot_import.h"
#include "robot/robot_parts.h"
#include "support/asset_mesh.h"
#include "support/oracles/chain_oracle.h"

namespace galactic::test::bullet_kinematics_test {
namespace {

/// Single precision along the chains of real robots.
constexpr double kLengthTolerance = 1e-5;
constexpr double kAngleTolerance = 1e-5;
constexpr int kVectors = 50;

Eigen::Isometry3d transformOf(const bake::Affine& m) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      transform.matrix()(row, column) = m[static_cast<std::size_t>(4 * row + column)];
    }
  }
  return transform;
}

/// What the oracles make of a link, straight from the import; positions as flattenKinematics
/// documents them.
std::vector<OracleLink> oracleOf(const bake::SourceRobot& robot) {
  std::vector<OracleLink> oracle;
  int positions = 0;
  for (const bake::SourceLink& link : robot.links) {
    OracleLink& made = oracle.emplace_back();
    made.parent_from_joint = transformOf(link.parent_from_joint);
    made.axis = {link.axis[0], link.axis[1], link.axis[2]};
    made.parent = link.parent;
    if (link.parent < 0) continue;
    made.type = link.joint_type;
    if (link.mimic || link.joint_type == JointType::kFixed) continue;
    made.position = positions;
    positions += static_cast<int>(positionCount(link.joint_type));
  }
  for (std::size_t n = 0; n < oracle.size(); ++n) {
    const auto& mimic = robot.links[n].mimic;
    if (!mimic) continue;
    oracle[n].position = oracle[mimic->link].position;
    oracle[n].multiplier = mimic->multiplier;
    oracle[n].offset = mimic->offset;
  }
  return oracle;
}

btVector3 toBullet(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

btQuaternion toBullet(const Eigen::Quaterniond& q) {
  return {static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()), static_cast<btScalar>(q.z()),
          static_cast<btScalar>(q.w())};
}

Eigen::Isometry3d fromBullet(const btTransform& transform) {
  const btQuaternion q = transform.getRotation();
  const btVector3& t = transform.getOrigin();
  const auto d = [](btScalar value) { return static_cast<double>(value); };
  Eigen::Isometry3d made = Eigen::Isometry3d::Identity();
  made.linear() =
      Eigen::Quaterniond(d(q.w()), d(q.x()), d(q.y()), d(q.z())).normalized().toRotationMatrix();
  made.translation() = Eigen::Vector3d(d(t.x()), d(t.y()), d(t.z()));
  return made;
}

/// The robot as a Bullet multibody of massless links; link n of the robot is Bullet's n - 1.
class BulletChain {
 public:
  explicit BulletChain(const std::vector<OracleLink>& links)
      : links_(links),
        body_(static_cast<int>(links.size()) - 1, 0, btVector3(0, 0, 0), true, false) {
    const btVector3 none(0, 0, 0);
    for (int n = 1; n < static_cast<int>(links.size()); ++n) {
      const OracleLink& link = links[static_cast<std::size_t>(n)];
      const int parent = link.parent - 1;
      const btQuaternion joint_from_parent =
          toBullet(Eigen::Quaterniond(link.parent_from_joint.linear()).normalized().conjugate());
      const btVector3 offset = toBullet(link.parent_from_joint.translation());
      const btVector3 axis = toBullet(link.axis);
      if (link.type == JointType::kRevolute || link.type == JointType::kContinuous) {
        body_.setupRevolute(n - 1, 1, none, parent, joint_from_parent, axis, offset, none);
      } else if (link.type == JointType::kPrismatic) {
        body_.setupPrismatic(n - 1, 1, none, parent, joint_from_parent, axis, offset, none, true);
      } else {
        body_.setupFixed(n - 1, 1, none, parent, joint_from_parent, offset, none);
      }
    }
    body_.finalizeMultiDof();
  }

  std::vector<Eigen::Isometry3d> poses(const Eigen::Isometry3d& world_from_root,
                                       std::span<const float> positions) {
    body_.setBasePos(toBullet(world_from_root.translation()));
    body_.setWorldToBaseRot(
        toBullet(Eigen::Quaterniond(world_from_root.linear()).normalized().conjugate()));
    for (int n = 1; n < static_cast<int>(links_.size()); ++n) {
      const OracleLink& link = links_[static_cast<std::size_t>(n)];
      if (link.position < 0) continue;
      const auto position = static_cast<double>(positions[static_cast<std::size_t>(link.position)]);
      body_.setJointPos(n - 1, static_cast<btScalar>(link.multiplier * position + link.offset));
    }
    body_.forwardKinematics(rotations_, vectors_);
    std::vector<Eigen::Isometry3d> made{world_from_root};
    for (int n = 0; n < body_.getNumLinks(); ++n) {
      made.push_back(fromBullet(body_.getLink(n).m_cachedWorldTransform));
    }
    return made;
  }

 private:
  const std::vector<OracleLink>& links_;
  btMultiBody body_;
  btAlignedObjectArray<btQuaternion> rotations_;
  btAlignedObjectArray<btVector3> vectors_;
};

/// Within the limits, half a turn or half a meter to each side where there is none.
std::vector<float> randomPositions(const bake::FlatKinematics& flat, std::mt19937& random) {
  constexpr float kFar = 100;
  std::vector<float> positions;
  for (const PositionLimits& limits : flat.limits) {
    const float lower = std::max(limits.lower, -std::numbers::pi_v<float>);
    const float upper = std::min(limits.upper, std::numbers::pi_v<float>);
    EXPECT_LT(lower, kFar);
    positions.push_back(lower + (upper - lower) * static_cast<float>(random()) * 0x1p-32F);
  }
  return positions;
}

class RealKinematics : public testing::TestWithParam<const char*> {};

TEST_P(RealKinematics, AgreeWithADoubleChainAndWithBullet) {
  if (!hasAsset(GetParam())) GTEST_SKIP() << "no asset " << GetParam();
  bake::RobotImportOptions options;
  options.allow_missing = true;
  const auto robot = bake::importRobot(assetsFolder() / GetParam(), options);
  ASSERT_TRUE(robot.has_value()) << robot.error().text();
  const bake::FlatKinematics flat = bake::flattenKinematics(*robot, nullptr);
  const std::vector<OracleLink> oracle = oracleOf(*robot);
  const bool for_bullet = std::none_of(oracle.begin(), oracle.end(), [](const OracleLink& link) {
    return link.type == JointType::kPlanar || link.type == JointType::kFloating;
  });
  BulletChain bullet(oracle);
  constexpr std::uint32_t kSeed = 20240615;
  std::mt19937 random(kSeed);
  PoseDifference from_chain;
  PoseDifference from_bullet;
  const Pose root{{0.5F, 0.25F, -0.75F}, {0, 0.6F, 0, 0.8F}};
  for (int vector = 0; vector < kVectors; ++vector) {
    const std::vector<float> positions = randomPositions(flat, random);
    std::vector<Pose> poses(flat.links.size());
    forwardKinematics(flat.links, root, positions, poses);
    const auto wanted = oraclePoses(oracle, toEigen(root), positions);
    for (std::size_t n = 0; n < poses.size(); ++n) from_chain.add(poses[n], wanted[n]);
    if (!for_bullet) continue;
    const auto simulated = bullet.poses(toEigen(root), positions);
    for (std::size_t n = 0; n < poses.size(); ++n) from_bullet.add(poses[n], simulated[n]);
  }
  EXPECT_LT(from_chain.translation, kLengthTolerance);
  EXPECT_LT(from_chain.rotation, kAngleTolerance);
  EXPECT_LT(from_bullet.translation, kLengthTolerance);
  EXPECT_LT(from_bullet.rotation, kAngleTolerance);
  std::printf(
      "%s: seed %u, %zu links, %zu positions: chain %.1e m %.1e rad, Bullet %.1e m %.1e "
      "rad%s\n",
      GetParam(), kSeed, flat.links.size(), flat.limits.size(), from_chain.translation,
      from_chain.rotation, from_bullet.translation, from_bullet.rotation,
      for_bullet ? "" : " (not compared)");
}

INSTANTIATE_TEST_SUITE_P(
    Assets, RealKinematics,
    testing::Values("replica_cad/urdf/cabinet/cabinet.urdf",
                    "replica_cad/urdf/cabinet/cabinet_dynamic.urdf",
                    "replica_cad/urdf/doors/door2.urdf", "replica_cad/urdf/fridge/fridge.urdf",
                    "replica_cad/urdf/fridge/fridge_dynamic.urdf",
                    "replica_cad/urdf/kitchen_counter/kitchen_counter.urdf",
                    "replica_cad/urdf/kitchen_cupboards/kitchenCupboard_01.urdf",
                    "robots/fetch/fetch_description/robots/fetch.urdf",
                    "robots/galactic_URDF/opt_fetch/robots/fetch.urdf",
                    "robots/galactic_URDF/spot_arm/urdf/spot_arm.urdf",
                    "robots/kuka_iiwa/model_free_base.urdf",
                    "robots/stretch/SE3/stretch_description_SE3_eoa_wrist_dw3_tool_sg3.urdf"));

}  // namespace
}  // namespace galactic::test::bullet_kinematics_test
