// Where bodies of an MJCF are: each way to say it worked out by hand, and chains of random joints
// against MuJoCo's own way to compute them, written down anew.
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <numbers>
#include <random>

#include "bake/robot_description/link_points.h"
#include "bake/robot_description/mjcf/mjcf_texts.h"

namespace galactic::test::mjcf::frames_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;

constexpr double kRounding = 1e-12;
constexpr double kQuarter = std::numbers::pi / 2;

/// Of a link's frame in its parent, both Z up.
bake::Affine zUp(const bake::Affine& m) {
  const bake::Affine z_from_y{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0};
  const bake::Affine y_from_z{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0};
  return product(product(z_from_y, m), y_from_z);
}

struct Orientation {
  const char* name;
  const char* attributes;
  /// Where X and Z of the body point in its parent.
  Point3 x;
  Point3 z;
  const char* compiler = "";
};

std::ostream& operator<<(std::ostream& out, const Orientation& one) { return out << one.name; }

const double kHalf = std::sqrt(0.5);

std::vector<Orientation> orientations() {
  return {
      {"None", "", {1, 0, 0}, {0, 0, 1}},
      {"Quat", "quat='1 0 0 1'", {0, 1, 0}, {0, 0, 1}},
      {"AxisAngleInDegrees", "axisangle='0 0 2 90'", {0, 1, 0}, {0, 0, 1}},
      {"AxisAngleInRadians",
       "axisangle='0 1 0 1.5707963267948966'",
       {0, 0, -1},
       {1, 0, 0},
       "<compiler angle='radian'/>"},
      {"EulerTurnsAboutTurnedAxes", "euler='90 90 0'", {0, 1, 0}, {1, 0, 0}},
      {"EulerTurnsAboutFixedAxes",
       "euler='90 90 0'",
       {0, 0, -1},
       {0, -1, 0},
       "<compiler eulerseq='XYZ'/>"},
      {"EulerInAnotherOrder",
       "euler='90 90 0'",
       {0, 1, 0},
       {1, 0, 0},
       "<compiler eulerseq='zxy'/>"},
      {"XyAxes", "xyaxes='0 2 0 -1 5 0'", {0, 1, 0}, {0, 0, 1}},
      {"ZAxis", "zaxis='3 0 0'", {0, 0, -1}, {1, 0, 0}},
      {"ZAxisUpsideDown", "zaxis='0 0 -1'", {1, 0, 0}, {0, 0, -1}},
      {"ZAxisAskew", "zaxis='1 0 1'", {kHalf, 0, -kHalf}, {kHalf, 0, kHalf}},
  };
}

class MjcfOrientations : public testing::TestWithParam<Orientation> {};

TEST_P(MjcfOrientations, AreAsWorkedOutByHand) {
  const ScratchFolder folder;
  const std::string text =
      mjcfText(fmt::format("<body name='a'><body name='b' pos='1 2 3' {}><joint/></body></body>",
                           GetParam().attributes),
               GetParam().compiler);
  const auto robot = mjcfRobot(folder, text);
  ASSERT_EQ(robot.links.size(), 2U);
  const bake::Affine m = zUp(robot.links[1].parent_from_joint);
  EXPECT_THAT((Point3{m[0], m[4], m[8]}), Pointwise(DoubleNear(kRounding), GetParam().x));
  EXPECT_THAT((Point3{m[2], m[6], m[10]}), Pointwise(DoubleNear(kRounding), GetParam().z));
  EXPECT_THAT((Point3{m[3], m[7], m[11]}), Pointwise(DoubleNear(kRounding), Point3{1, 2, 3}));
}

INSTANTIATE_TEST_SUITE_P(Each, MjcfOrientations, testing::ValuesIn(orientations()),
                         [](const auto& one) { return one.param.name; });

TEST(MjcfFrames, OfAJointBesideItsBodyAreThoseOfALinkBeforeIt) {
  const ScratchFolder folder;
  const auto robot =
      mjcfRobot(folder, mjcfText("<body name='a'><body name='b' pos='1 0 0'>"
                                 "<joint name='j' pos='0 0 0.5' axis='0 1 0' range='-90 45'/>"
                                 "<geom type='box' size='.1 .1 .1'/></body></body>"));
  ASSERT_EQ(robot.links.size(), 3U);
  const bake::SourceLink& hinge = robot.links[1];
  EXPECT_EQ(hinge.name, "b_j");
  EXPECT_EQ(hinge.joint_name, "j");
  EXPECT_EQ(hinge.joint_type, JointType::kRevolute);
  EXPECT_THAT(hinge.axis, ElementsAre(0, 0, -1));
  EXPECT_NEAR(hinge.limits->lower, -kQuarter, kRounding);
  EXPECT_NEAR(hinge.limits->upper, kQuarter / 2, kRounding);
  EXPECT_TRUE(hinge.collisions.empty());
  EXPECT_EQ(hinge.parent_from_joint, (bake::Affine{1, 0, 0, 1, 0, 1, 0, 0.5, 0, 0, 1, 0}));
  const bake::SourceLink& body = robot.links[2];
  EXPECT_EQ(body.name, "b");
  EXPECT_EQ(body.parent, 1);
  EXPECT_EQ(body.joint_name, "b_fixed");
  EXPECT_EQ(body.joint_type, JointType::kFixed);
  EXPECT_EQ(body.parent_from_joint, (bake::Affine{1, 0, 0, 0, 0, 1, 0, -0.5, 0, 0, 1, 0}));
  EXPECT_EQ(body.collisions.size(), 1U);
}

TEST(MjcfFrames, OfABodyWithSeveralJointsAreThoseOfAChain) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(
      folder, mjcfText("<body name='a'><body name='b' pos='1 0 0'>"
                       "<joint name='pan' axis='0 0 1'/><joint name='tilt' axis='0 3 0'/>"
                       "<joint name='out' type='slide' axis='1 0 0' pos='9 9 9' range='0 .5'/>"
                       "<geom type='box' size='.1 .1 .1'/></body></body>"));
  ASSERT_EQ(robot.links.size(), 4U);
  EXPECT_EQ(robot.links[1].name, "b_pan");
  EXPECT_EQ(robot.links[1].joint_type, JointType::kContinuous);
  EXPECT_EQ(robot.links[2].name, "b_tilt");
  EXPECT_THAT(robot.links[2].axis, ElementsAre(0, 0, -1));
  EXPECT_EQ(robot.links[3].name, "b");
  EXPECT_EQ(robot.links[3].joint_name, "out");
  EXPECT_EQ(robot.links[3].joint_type, JointType::kPrismatic);
  EXPECT_EQ(robot.links[3].limits->upper, 0.5);
  EXPECT_TRUE(robot.warnings.empty()) << robot.warnings.front();
}

TEST(MjcfFrames, InFrameElementsAreThoseOfTheirContent) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(folder, mjcfText("<frame pos='0 0 5'><body name='a'>"
                                                "<frame pos='1 0 0' euler='0 0 90'>"
                                                "<geom type='sphere' size='.1' pos='1 0 0'/>"
                                                "<frame pos='1 0 0'><body name='b' pos='1 0 0'>"
                                                "<joint name='j' axis='1 0 0'/></body></frame>"
                                                "</frame></body></frame>"));
  ASSERT_EQ(robot.links.size(), 2U);
  const bake::Affine b = zUp(robot.links[1].parent_from_joint);
  EXPECT_THAT((Point3{b[3], b[7], b[11]}), Pointwise(DoubleNear(kRounding), Point3{1, 2, 0}));
  EXPECT_THAT((Point3{b[0], b[4], b[8]}), Pointwise(DoubleNear(kRounding), Point3{0, 1, 0}));
  const bake::Affine geom = zUp(robot.links[0].collisions.at(0).link_from_shape);
  EXPECT_THAT((Point3{geom[3], geom[7], geom[11]}),
              Pointwise(DoubleNear(kRounding), Point3{1, 1, 0}));
}

TEST(MjcfFrames, OfJointsInFrameElementsAreTheFrames) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(folder, mjcfText("<body name='a'><body name='b'>"
                                                "<frame pos='1 0 0' euler='0 0 90'>"
                                                "<joint name='j' pos='2 0 0' axis='1 0 0'/></frame>"
                                                "<geom size='.1'/></body></body>"));
  ASSERT_EQ(robot.links.size(), 3U);
  const bake::Affine hinge = zUp(robot.links[1].parent_from_joint);
  EXPECT_THAT((Point3{hinge[3], hinge[7], hinge[11]}),
              Pointwise(DoubleNear(kRounding), Point3{1, 2, 0}));
  // Y of the file is -Z here.
  EXPECT_THAT(robot.links[1].axis, Pointwise(DoubleNear(kRounding), Point3{0, 0, -1}));
}

TEST(MjcfFrames, OfJointsCountFromTheirReferenceInTheFilesUnit) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(
      folder, mjcfText("<body name='a'><body name='b'><joint name='j' ref='90'/><geom size='.1'/>"
                       "<body name='c'><joint name='k' type='slide' axis='1 0 0' ref='0.5'/>"
                       "<geom size='.1'/></body></body></body>"));
  ASSERT_EQ(robot.links.size(), 3U);
  const bake::Affine turned = zUp(robot.links[1].parent_from_joint);
  EXPECT_THAT((Point3{turned[0], turned[4], turned[8]}),
              Pointwise(DoubleNear(kRounding), Point3{0, -1, 0}));
  EXPECT_NEAR(robot.links[2].parent_from_joint[3], -0.5, kRounding);
}

TEST(MjcfFrames, OfCamerasLookAlongX) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(
      folder,
      mjcfText("<body name='a'><geom size='.1'/><camera name='eye' pos='1 2 3'/><camera/>"
               "<camera name='a' quat='.5 .5 -.5 -.5'/><camera name='t' mode='track'/></body>"));
  ASSERT_EQ(robot.links.size(), 3U);
  EXPECT_EQ(robot.links[1].name, "eye");
  EXPECT_EQ(robot.links[1].joint_name, "eye_fixed");
  EXPECT_TRUE(robot.links[1].is_camera && robot.links[2].is_camera);
  EXPECT_FALSE(robot.links[0].is_camera);
  const bake::Affine eye = zUp(robot.links[1].parent_from_joint);
  EXPECT_THAT((Point3{eye[3], eye[7], eye[11]}), ElementsAre(1, 2, 3));
  EXPECT_THAT((Point3{eye[0], eye[4], eye[8]}), ElementsAre(0, 0, -1));
  EXPECT_THAT((Point3{eye[2], eye[6], eye[10]}), ElementsAre(0, 1, 0));
  // Turned so that it looks along X of its body, upright.
  EXPECT_EQ(robot.links[2].name, "a_");
  const bake::Affine forward = zUp(robot.links[2].parent_from_joint);
  EXPECT_THAT((Point3{forward[0], forward[4], forward[8]}),
              Pointwise(DoubleNear(kRounding), Point3{1, 0, 0}));
  EXPECT_THAT((Point3{forward[2], forward[6], forward[10]}),
              Pointwise(DoubleNear(kRounding), Point3{0, 0, 1}));
}

TEST(MjcfFrames, OfTheRootAreTheWorldsWhereItMovesAgainstItOrStandsAskew) {
  const ScratchFolder folder;
  const std::string arm = "<geom size='.1'/><body name='b'><joint name='j'/></body>";
  for (const char* upright : {"", "pos='1 2 3'", "euler='0 0 30'"}) {
    const auto robot = mjcfRobot(
        folder, mjcfText(fmt::format("<body name='a' {}><freejoint/>{}</body>", upright, arm)));
    EXPECT_EQ(robot.links.front().name, "a") << upright;
    EXPECT_EQ(robot.links.size(), 2U);
  }
  const auto askew = mjcfRobot(
      folder, mjcfText(fmt::format("<body name='a' pos='1 2 3' euler='90 0 0'>{}</body>", arm)));
  ASSERT_EQ(askew.links.size(), 3U);
  EXPECT_EQ(askew.links[0].name, "world");
  const bake::Affine a = zUp(askew.links[1].parent_from_joint);
  EXPECT_THAT((Point3{a[3], a[7], a[11]}), ElementsAre(0, 0, 3));
  EXPECT_THAT((Point3{a[2], a[6], a[10]}), Pointwise(DoubleNear(kRounding), Point3{0, -1, 0}));
  const auto upside_down =
      mjcfRobot(folder, mjcfText(fmt::format("<body name='a' euler='180 0 0'>{}</body>", arm)));
  ASSERT_EQ(upside_down.links.size(), 3U);
  EXPECT_EQ(upside_down.links[0].name, "world");
  EXPECT_NEAR(zUp(upside_down.links[1].parent_from_joint)[10], -1, kRounding);
  const auto on_rail = mjcfRobot(
      folder, mjcfText("<body name='a' pos='1 2 3'><joint name='rail' type='slide' axis='1 0 0'/>"
                       "<geom size='.1'/></body>"));
  ASSERT_EQ(on_rail.links.size(), 2U);
  EXPECT_EQ(on_rail.links[0].name, "world");
  EXPECT_EQ(on_rail.links[1].joint_name, "rail");
  EXPECT_EQ(zUp(on_rail.links[1].parent_from_joint)[3], 1);
}

TEST(MjcfFrames, OfABaseThatDrivesLoseTheJointsThatDriveIt) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(
      folder, mjcfText("<body name='base'><joint name='x' type='slide' axis='1 0 0'/>"
                       "<joint name='y' type='slide' axis='0 1 0'/><joint name='yaw'/>"
                       "<geom size='.1'/><body name='b'><joint name='j'/></body></body>"));
  ASSERT_EQ(robot.links.size(), 2U);
  EXPECT_EQ(robot.links[0].name, "base");
  EXPECT_THAT(robot.warnings,
              testing::Contains("the joints of body 'base' drive it over the floor, "
                                "as a robot's base does by itself; they are left "
                                "out"));
}

TEST(MjcfFrames, OfARootThatCannotReachTheWholeFloorKeepItsJoints) {
  const ScratchFolder folder;
  const std::string along_x = "<joint name='x' type='slide' axis='1 0 0'/>";
  const std::string along_y = "<joint name='y' type='slide' axis='0 1 0'/>";
  struct Root {
    std::string joints;
    std::size_t joint_count;
  };
  const std::vector<Root> roots{
      {along_x + "<joint name='back' type='slide' axis='-1 0 0'/>", 2},
      {along_x + "<joint name='yaw'/>", 2},
      {along_x + along_y + "<joint name='yaw'/><joint name='wrist'/>", 4},
      {along_x + along_y + "<joint name='roll' axis='1 0 0'/>", 3},
  };
  for (const auto& [joints, joint_count] : roots) {
    const auto robot = mjcfRobot(
        folder, mjcfText(fmt::format("<body name='base'>{}<geom size='.1'/></body>", joints)));
    EXPECT_EQ(robot.links.front().name, "world") << joints;
    EXPECT_EQ(robot.links.back().name, "base") << joints;
    EXPECT_EQ(robot.links.size(), 1 + joint_count) << joints;
  }
}

TEST(MjcfFrames, OfSeveralArmsThatAreFixedToTheWorldAreOneRobots) {
  const ScratchFolder folder;
  const auto robot = mjcfRobot(
      folder,
      mjcfText("<body name='table'><geom size='.1'/></body>"
               "<body name='left' pos='0 1 0'><body name='l'><joint name='i'/></body></body>"
               "<body name='right' pos='0 -1 0'><body name='r'><joint name='j'/></body>"
               "</body>"));
  ASSERT_EQ(robot.links.size(), 5U);
  EXPECT_EQ(robot.links[0].name, "world");
  EXPECT_EQ(linkOf(robot, "left").parent, 0);
  EXPECT_EQ(zUp(linkOf(robot, "right").parent_from_joint)[7], -1);
  EXPECT_THAT(robot.warnings,
              testing::Contains("bodies of the world without joints are no part of the robot: "
                                "'table'"));
}

/// A body with joints as an MJCF states it, and as it moves.
struct RandomBody {
  int parent = -1;
  Eigen::Vector3d position;
  Eigen::Quaterniond rotation;
  struct Joint {
    bool slides = false;
    Eigen::Vector3d anchor;
    Eigen::Vector3d axis;
    double reference = 0;
  };
  std::vector<Joint> joints;
};

/// A random tree, each body in one of those before it.
class RandomTree {
 public:
  explicit RandomTree(unsigned seed) : random_(seed) {
    bodies_.emplace_back();
    for (int n = 1; n <= 12; ++n) {
      RandomBody& body = bodies_.emplace_back();
      body.parent = static_cast<int>(random_() % static_cast<unsigned>(n));
      body.position = vector();
      body.rotation = Eigen::Quaterniond(number(), number(), number(), number() + 2).normalized();
      const unsigned joints = random_() % 4;
      for (unsigned j = 0; j < joints; ++j) {
        RandomBody::Joint& joint = body.joints.emplace_back();
        joint.slides = random_() % 3 == 0;
        joint.anchor = random_() % 2 == 0 ? vector() : Eigen::Vector3d(0, 0, 0);
        joint.axis = vector().normalized();
        joint.reference = random_() % 2 == 0 ? number() : 0;
      }
    }
  }

  [[nodiscard]] std::string text() const {
    return mjcfText(textOf(0), "<compiler angle='radian'/>");
  }

  /// By their numbers, in the frame of the first; `positions` by body and joint (mj_kinematics).
  [[nodiscard]] std::vector<Eigen::Isometry3d> poses(
      const std::vector<std::vector<double>>& positions) const {
    std::vector<Eigen::Isometry3d> placed(bodies_.size(), Eigen::Isometry3d::Identity());
    for (std::size_t n = 1; n < bodies_.size(); ++n) {
      const RandomBody& body = bodies_[n];
      const Eigen::Isometry3d& parent = placed[static_cast<std::size_t>(body.parent)];
      Eigen::Vector3d at = parent * body.position;
      Eigen::Quaterniond turned = Eigen::Quaterniond(parent.linear()) * body.rotation;
      for (std::size_t j = 0; j < body.joints.size(); ++j) {
        const RandomBody::Joint& joint = body.joints[j];
        const double moved = positions[n][j] - joint.reference;
        if (joint.slides) {
          at += turned * joint.axis * moved;
          continue;
        }
        const Eigen::Vector3d anchor = turned * joint.anchor + at;
        turned = turned * Eigen::AngleAxisd(moved, joint.axis);
        at = anchor - turned * joint.anchor;
      }
      placed[n].linear() = turned.toRotationMatrix();
      placed[n].translation() = at;
    }
    return placed;
  }

  [[nodiscard]] std::vector<std::vector<double>> randomPositions() {
    std::vector<std::vector<double>> positions;
    for (const RandomBody& body : bodies_) {
      auto& own = positions.emplace_back();
      for (std::size_t j = 0; j < body.joints.size(); ++j) own.push_back(3 * number());
    }
    return positions;
  }

 private:
  double number() {
    return 2.0 * (static_cast<double>(random_()) / static_cast<double>(std::mt19937::max())) - 1;
  }
  Eigen::Vector3d vector() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }

  [[nodiscard]] std::string textOf(std::size_t n) const {
    const RandomBody& body = bodies_[n];
    std::string text = fmt::format("<body name='{}'", n);
    if (n > 0) {
      const auto& [p, q] = std::tie(body.position, body.rotation);
      text += fmt::format(" pos='{} {} {}' quat='{} {} {} {}'", p.x(), p.y(), p.z(), q.w(), q.x(),
                          q.y(), q.z());
    }
    text += "><geom size='.1'/>";
    for (std::size_t j = 0; j < body.joints.size(); ++j) {
      const RandomBody::Joint& joint = body.joints[j];
      text += fmt::format(
          "<joint name='{}/{}' type='{}' pos='{} {} {}' axis='{} {} {}' ref='{}' range='-9 9'/>", n,
          j, joint.slides ? "slide" : "hinge", joint.anchor.x(), joint.anchor.y(), joint.anchor.z(),
          joint.axis.x(), joint.axis.y(), joint.axis.z(), joint.reference);
    }
    for (std::size_t child = n + 1; child < bodies_.size(); ++child) {
      if (bodies_[child].parent == static_cast<int>(n)) text += textOf(child);
    }
    return text + "</body>";
  }

  std::mt19937 random_;
  std::vector<RandomBody> bodies_;
};

bake::Affine affineOf(const Eigen::Isometry3d& transform) {
  bake::Affine affine{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      affine[static_cast<std::size_t>(4 * row + column)] = transform.matrix()(row, column);
    }
  }
  return affine;
}

/// Poses of the links in the root's frame (Y up), in double precision.
std::vector<bake::Affine> posesOf(const bake::SourceRobot& robot,
                                  const std::vector<std::vector<double>>& positions) {
  std::vector<bake::Affine> placed;
  for (const bake::SourceLink& link : robot.links) {
    if (link.parent < 0) {
      placed.push_back({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
      continue;
    }
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    const Eigen::Vector3d axis(link.axis[0], link.axis[1], link.axis[2]);
    if (link.joint_type != JointType::kFixed) {
      const std::size_t slash = link.joint_name.find('/');
      const double position = positions[std::stoul(link.joint_name.substr(0, slash))]
                                       [std::stoul(link.joint_name.substr(slash + 1))];
      if (link.joint_type == JointType::kPrismatic) {
        moved.translation() = position * axis;
      } else {
        moved.linear() = Eigen::AngleAxisd(position, axis).toRotationMatrix();
      }
    }
    placed.push_back(product(placed[static_cast<std::size_t>(link.parent)],
                             product(link.parent_from_joint, affineOf(moved))));
  }
  return placed;
}

TEST(MjcfFrames, MoveAsMuJoCoMovesThem) {
  std::size_t beside = 0;
  std::size_t joints = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const ScratchFolder folder;
    RandomTree tree(seed);
    const auto robot = mjcfRobot(folder, tree.text());
    const auto positions = tree.randomPositions();
    const auto expected = tree.poses(positions);
    const auto placed = posesOf(robot, positions);
    std::size_t bodies = 0;
    for (std::size_t n = 0; n < robot.links.size(); ++n) {
      const std::string& name = robot.links[n].name;
      if (robot.links[n].joint_type != JointType::kFixed) ++joints;
      if (name.find('_') != std::string::npos) {
        ++beside;
        continue;
      }
      ++bodies;
      const Eigen::Isometry3d& pose = expected[std::stoul(name)];
      for (const Point3& p : {Point3{0, 0, 0}, Point3{1, 2, 3}}) {
        const Eigen::Vector3d where = pose * Eigen::Vector3d(p[0], p[1], p[2]);
        EXPECT_THAT(pointIn(placed[n], {p[0], p[2], -p[1]}),
                    Pointwise(DoubleNear(1e-11), Point3{where.x(), where.z(), -where.y()}))
            << "seed " << seed << " body " << name;
      }
    }
    EXPECT_EQ(bodies, 13U);
  }
  // Links without shape before bodies, and joints that need none.
  EXPECT_GT(beside, joints / 10);
  EXPECT_LT(beside, joints);
}

}  // namespace
}  // namespace galactic::test::mjcf::frames_test
