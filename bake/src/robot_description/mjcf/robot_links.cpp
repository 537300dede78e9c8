#include "robot_description/mjcf/robot_links.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "import/affine.h"
#include "robot_description/mjcf/unique_name.h"

namespace galactic::bake {
namespace {

constexpr const char* kWorld = "world";

/// Smaller sines of angles count as 0, because numbers in files are rounded.
constexpr double kUprightness = 1e-3;

bool isVertical(const std::array<double, 3>& axis) {
  return std::hypot(axis[0], axis[1]) < kUprightness;
}

bool isHorizontal(const std::array<double, 3>& axis) { return std::abs(axis[2]) < kUprightness; }

bool isUpright(const Affine& pose) {
  return isVertical({pose[2], pose[6], pose[10]}) && pose[10] > 0;
}

bool moves(const MjcfJoint& joint) {
  return joint.type == MjcfJointType::kHinge || joint.type == MjcfJointType::kSlide;
}

/// Whether the joints are those of a body that drives on a floor: two that slide, and perhaps one
/// that turns about the vertical.
bool isPlanarBase(const std::vector<MjcfJoint>& joints) {
  std::vector<const MjcfJoint*> slides;
  std::size_t turns = 0;
  for (const MjcfJoint& joint : joints) {
    const bool slides_along = joint.type == MjcfJointType::kSlide && isHorizontal(joint.axis);
    const bool turns_about = joint.type == MjcfJointType::kHinge && isVertical(joint.axis);
    if (slides_along) slides.push_back(&joint);
    turns += turns_about ? 1 : 0;
    if (!slides_along && !turns_about) return false;
  }
  if (slides.size() != 2 || turns > 1) return false;
  const auto& a = slides[0]->axis;
  const auto& b = slides[1]->axis;
  return std::abs(a[0] * b[1] - a[1] * b[0]) > 0.5;
}

std::string namesOf(const MjcfWorld& world, const std::vector<std::size_t>& bodies) {
  constexpr std::size_t kMost = 6;
  std::string names;
  for (std::size_t n = 0; n < std::min(bodies.size(), kMost); ++n) {
    names += fmt::format("{}'{}'", n == 0 ? "" : ", ", world.bodies[bodies[n]].name);
  }
  return bodies.size() > kMost ? names + fmt::format(" and {} more", bodies.size() - kMost) : names;
}

/// The bodies directly in the world, and which of them have joints that turn or slide.
struct Candidates {
  std::vector<std::size_t> all;
  std::vector<std::size_t> jointed;
  std::vector<std::size_t> rigid;
};

Candidates candidatesOf(const MjcfWorld& world) {
  Candidates candidates;
  std::vector<std::size_t> top(world.bodies.size());
  std::vector<bool> has_joints(world.bodies.size(), false);
  for (std::size_t n = 0; n < world.bodies.size(); ++n) {
    const MjcfBody& body = world.bodies[n];
    top[n] = body.parent < 0 ? n : top[static_cast<std::size_t>(body.parent)];
    if (std::ranges::any_of(body.joints, moves)) has_joints[top[n]] = true;
    if (body.parent < 0) candidates.all.push_back(n);
  }
  for (const std::size_t n : candidates.all) {
    (has_joints[n] ? candidates.jointed : candidates.rigid).push_back(n);
  }
  return candidates;
}

bool isFree(const MjcfBody& body) {
  return std::ranges::any_of(
      body.joints, [](const MjcfJoint& joint) { return joint.type == MjcfJointType::kFree; });
}

/// Makes links and joints from the bodies of the robot.
class LinkMaker {
 public:
  LinkMaker(const MjcfWorld& world, const RobotBodies& chosen, const MjcfSettings& settings,
            MjcfFindings& findings, RobotDescription& robot)
      : world_(world), chosen_(chosen), settings_(settings), findings_(findings), robot_(robot) {
    for (const MjcfBody& body : world.bodies) {
      link_names_.insert(body.name);
      for (const MjcfJoint& joint : body.joints) joint_names_.insert(joint.name);
    }
  }

  void add(DescriptionPart part) {
    if (chosen_.hangs_from_world) robot_.links.emplace_back().name = kWorld;
    const bool any_looks = std::ranges::any_of(world_.bodies, [&](const MjcfBody& body) {
      return isPart(body) && std::ranges::any_of(body.geoms, isSeen);
    });
    for (const MjcfBody& body : world_.bodies) {
      if (!isPart(body)) continue;
      addJoints(body);
      DescribedLink& link = robot_.links.emplace_back();
      link.name = body.name;
      addShapes(body, any_looks, link);
      if (part == DescriptionPart::kMasses) addMasses(body, link);
      for (const MjcfCamera& camera : body.cameras) addCamera(body, camera);
    }
  }

 private:
  [[nodiscard]] bool isPart(const MjcfBody& body) const {
    return chosen_.is_part[static_cast<std::size_t>(&body - world_.bodies.data())];
  }

  static bool isSeen(const MjcfGeom& geom) { return geom.is_shown && !geom.is_invisible; }

  /// Adds the joints between a body and its parent, and the links between these joints.
  void addJoints(const MjcfBody& body) {
    const bool is_first = body.parent < 0;
    if (is_first && !chosen_.hangs_from_world) return;
    std::string parent =
        is_first ? kWorld : world_.bodies[static_cast<std::size_t>(body.parent)].name;
    Affine parent_from_here = body.parent_from_body;
    const bool is_base = is_first && !chosen_.moves_against_world;
    // The position of a base on the floor says nothing about the robot.
    if (is_base) parent_from_here[3] = parent_from_here[7] = 0;
    bool reached = false;
    for (const MjcfJoint& joint : body.joints) {
      if (is_base) break;
      if (joint.type == MjcfJointType::kBall) {
        findings_.warn(
            fmt::format("joint '{}' is a ball joint, which robots of packs do not have; "
                        "it is held where it is",
                        joint.name));
      }
      if (!moves(joint)) continue;
      const bool is_beside = joint.anchor != std::array<double, 3>{};
      reached = &joint == &body.joints.back() && !is_beside;
      const std::string child = reached ? body.name : intermediateLink(body, joint);
      robot_.joints.push_back(jointBetween(parent, child, parent_from_here, joint));
      parent_from_here = translationOf({-joint.anchor[0], -joint.anchor[1], -joint.anchor[2]});
      parent = child;
    }
    if (!reached) addFixed(parent, body.name, parent_from_here);
  }

  void addFixed(const std::string& parent, const std::string& child, const Affine& frame) {
    DescribedJoint fixed;
    fixed.name = uniqueName(child + "_fixed", joint_names_);
    fixed.parent = parent;
    fixed.child = child;
    fixed.parent_from_joint = frame;
    robot_.joints.push_back(std::move(fixed));
  }

  /// Adds a link that a recipe can name for its camera.
  void addCamera(const MjcfBody& body, const MjcfCamera& camera) {
    const std::string name = uniqueName(camera.name, link_names_);
    DescribedLink& link = robot_.links.emplace_back();
    link.name = name;
    link.is_camera = true;
    addFixed(body.name, name, camera.body_from_view);
  }

  static DescribedJoint jointBetween(const std::string& parent, const std::string& child,
                                     const Affine& parent_from_here, const MjcfJoint& joint) {
    const bool turns = joint.type == MjcfJointType::kHinge;
    DescribedJoint made;
    made.name = joint.name;
    made.parent = parent;
    made.child = child;
    made.axis = joint.axis;
    made.has_limits = joint.is_limited;
    made.lower = joint.lower;
    made.upper = joint.upper;
    made.type = turns ? (joint.is_limited ? JointType::kRevolute : JointType::kContinuous)
                      : JointType::kPrismatic;
    if (made.type == JointType::kContinuous) made.lower = made.upper = 0;
    made.parent_from_joint = compose(parent_from_here, translationOf(joint.anchor));
    // At its reference position the body has its pose from the text.
    if (joint.reference != 0) {
      const Affine back =
          turns ? rotationAbout(joint.axis, -joint.reference)
                : translationOf({-joint.reference * joint.axis[0], -joint.reference * joint.axis[1],
                                 -joint.reference * joint.axis[2]});
      made.parent_from_joint = compose(made.parent_from_joint, back);
    }
    return made;
  }

  std::string intermediateLink(const MjcfBody& body, const MjcfJoint& joint) {
    DescribedLink& link = robot_.links.emplace_back();
    link.name = uniqueName(fmt::format("{}_{}", body.name, joint.name), link_names_);
    return link.name;
  }

  /// Collision shapes are also drawn if the body has no other shapes to draw. Shapes that the
  /// viewer hides are drawn only if nothing else of the robot can be seen.
  static void addShapes(const MjcfBody& body, bool any_looks, DescribedLink& link) {
    const auto is_drawn = [&](const MjcfGeom& geom) {
      return !geom.is_invisible && (geom.is_shown || !any_looks);
    };
    const bool has_looks = std::ranges::any_of(
        body.geoms, [&](const MjcfGeom& geom) { return !geom.collides && is_drawn(geom); });
    for (const MjcfGeom& geom : body.geoms) {
      for (const DescribedShape& shape : geom.shapes) {
        if (geom.collides) link.collisions.push_back(plain(shape));
        if (is_drawn(geom) && geom.collides != has_looks) link.visuals.push_back(shape);
      }
    }
  }

  /// Removes the looks of a shape that is never drawn.
  static DescribedShape plain(DescribedShape shape) {
    shape.has_color = false;
    shape.hides_looks = true;
    shape.texture.clear();
    return shape;
  }

  void addMasses(const MjcfBody& body, DescribedLink& link) const {
    if (body.inertial) {
      link.inertials.push_back(*body.inertial);
      link.inertials.back().link = body.name;
      return;
    }
    if (settings_.inertias == MjcfSettings::Inertias::kStated) return;
    for (const MjcfGeom& geom : body.geoms) {
      if (geom.inertial) {
        link.inertials.push_back(*geom.inertial);
        link.inertials.back().link = body.name;
      }
      if (geom.mass) link.masses.push_back(*geom.mass);
    }
  }

  const MjcfWorld& world_;
  const RobotBodies& chosen_;
  const MjcfSettings& settings_;
  MjcfFindings& findings_;
  RobotDescription& robot_;
  NameSet link_names_{kWorld};
  NameSet joint_names_;
};

}  // namespace

RobotBodies chooseRobot(const MjcfWorld& world, const std::string& where, MjcfFindings& findings) {
  const Candidates candidates = candidatesOf(world);
  const std::vector<std::size_t>& first =
      candidates.jointed.empty() ? candidates.rigid : candidates.jointed;
  RobotBodies chosen;
  if (first.empty()) {
    findings.error(where, "its <worldbody> has no <body>, so there is no robot");
    return chosen;
  }
  const bool any_free =
      std::ranges::any_of(first, [&](std::size_t n) { return isFree(world.bodies[n]); });
  if (first.size() > 1 && (any_free || candidates.jointed.empty())) {
    findings.error(
        where, fmt::format("its <worldbody> has {} bodies that may be the robot, {}; give a file "
                           "with one robot",
                           first.size(), namesOf(world, first)));
    return chosen;
  }
  const MjcfBody& root = world.bodies[first.front()];
  const bool root_moves = std::ranges::any_of(root.joints, moves);
  chosen.drives_itself = first.size() == 1 && root_moves && isPlanarBase(root.joints);
  chosen.moves_against_world = first.size() > 1 || (root_moves && !chosen.drives_itself);
  chosen.hangs_from_world = chosen.moves_against_world || !isUpright(root.parent_from_body);
  for (std::size_t n = 0; n < world.bodies.size(); ++n) {
    const int parent = world.bodies[n].parent;
    chosen.is_part.push_back(parent < 0 ? std::ranges::find(first, n) != first.end()
                                        : chosen.is_part[static_cast<std::size_t>(parent)]);
  }
  if (chosen.drives_itself) {
    findings.warn(
        fmt::format("the joints of body '{}' drive it over the floor, as a robot's base "
                    "does by itself; they are left out",
                    root.name));
  }
  if (!candidates.jointed.empty() && !candidates.rigid.empty()) {
    findings.warn(fmt::format("bodies of the world without joints are no part of the robot: {}",
                              namesOf(world, candidates.rigid)));
  }
  if (world.loose_geoms > 0) {
    findings.warn(fmt::format("{} <geom> of the <worldbody> itself {} no part of the robot",
                              world.loose_geoms, world.loose_geoms == 1 ? "is" : "are"));
  }
  return chosen;
}

void addLinks(const MjcfWorld& world, const RobotBodies& chosen, const MjcfSettings& settings,
              DescriptionPart part, MjcfFindings& findings, RobotDescription& robot) {
  LinkMaker(world, chosen, settings, findings, robot).add(part);
}

}  // namespace galactic::bake
