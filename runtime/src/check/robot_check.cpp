#include <set>
#include <string_view>
#include <tuple>
#include <vector>

#include "check/asset_checks.h"
#include "check/common_check.h"
#include "check/offence.h"
#include "check/render_check.h"
#include "galactic/kinematics.h"

namespace galactic::detail {
namespace {

constexpr std::size_t kMaxLinks = 65535;
/// Limit for multiplier and offset of a joint that follows another.
constexpr float kMostMultiplier = 1000;
/// Limit for the step of one action, radians or meters.
constexpr float kMostStep = 1000;

/// Checks a robot part by part.
class RobotChecker {
 public:
  RobotChecker(const schema::Robot& robot, const std::string& where)
      : robot_(robot), offence_(where + ": robot") {}

  Result<void> run() {
    offence_.require(!isEmpty(robot_.name()), "name", "is empty, expected the robot's name");
    offence_.require(checkRadii(*robot_.radii(), offence_.where()));
    checkSizes();
    checkLinks();
    checkNames(*robot_.link_names(), {.field = "link_names", .owner = "link"});
    checkJointNames();
    checkPositions();
    checkGroups();
    checkPairs();
    checkControlledJoints();
    checkTools();
    checkSurfaces();
    checkRendered();
    return offence_.result();
  }

 private:
  void checkRendered() {
    if (robot_.render_meshes() == nullptr || offence_.found()) return;
    offence_.require(checkRenderMeshes(*robot_.render_meshes(), links(), offence_.where()));
  }

  [[nodiscard]] std::size_t links() const { return robot_.links()->size(); }
  [[nodiscard]] std::size_t positions() const { return robot_.limits()->size(); }

  void checkSizes() {
    offence_.require(links() >= 1 && links() <= kMaxLinks, "links",
                     "has {} links, expected 1 to {}", links(), kMaxLinks);
    offence_.require(robot_.link_names()->size() == links(), "link_names",
                     "has {} elements, expected {}, one per link", robot_.link_names()->size(),
                     links());
    offence_.require(robot_.joint_names()->size() == links(), "joint_names",
                     "has {} elements, expected {}, one per link", robot_.joint_names()->size(),
                     links());
    offence_.require(robot_.start_positions()->size() == positions(), "start_positions",
                     "has {} elements, expected {}, one per position",
                     robot_.start_positions()->size(), positions());
  }

  void checkLinks() {
    for (std::size_t n = 0; n < links() && !offence_.found(); ++n) checkLink(n);
  }

  void checkLink(std::size_t n) {
    const schema::LinkFrame& link = *robot_.links()->Get(static_cast<flatbuffers::uoffset_t>(n));
    const std::string field = fmt::format("links[{}]", n);
    const bool rooted = n == 0 ? link.parent() == -1
                               : link.parent() >= 0 && static_cast<std::size_t>(link.parent()) < n;
    offence_.require(rooted, field + ".parent",
                     "is {}, expected -1 for the first link and an earlier link for the others",
                     link.parent());
    offence_.require(
        isRigid(link.parent_from_joint(), kChainTolerance), field + ".parent_from_joint",
        "is not a rigid transform, expected up to {} m and a unit quaternion", kFarthest);
    offence_.require(link.type() <= schema::JointType::MAX, field + ".type",
                     "is {}, expected a value up to {}", static_cast<unsigned>(link.type()),
                     static_cast<unsigned>(schema::JointType::MAX));
    offence_.require(n > 0 || link.type() == schema::JointType::Fixed, field + ".type",
                     "is {} at the root, expected 0: it has no joint",
                     static_cast<unsigned>(link.type()));
    if (offence_.found()) return;
    offence_.require(std::fabs(link.multiplier()) <= kMostMultiplier &&
                         std::fabs(link.offset()) <= kMostMultiplier,
                     field + ".multiplier",
                     "or offset is not finite or too large, expected up to {} and {}",
                     kMostMultiplier, kMostMultiplier);
    const std::size_t values = positionCount(static_cast<JointType>(link.type()));
    if (values == 0) {
      offence_.require(link.position() == -1, field + ".position",
                       "is {} at a fixed joint, expected -1", link.position());
      return;
    }
    offence_.require(isUnit(link.axis(), kChainTolerance), field + ".axis",
                     "has not length 1, expected a direction");
    offence_.require(
        link.position() >= 0 && static_cast<std::size_t>(link.position()) + values <= positions(),
        field + ".position", "is {}, expected {} values among the {} positions", link.position(),
        values, positions());
  }

  /// The name of a list of names, what its names belong to, and the first element that must have
  /// one.
  struct NameList {
    const char* field;
    const char* owner;
    flatbuffers::uoffset_t begin = 0;
  };

  void checkNames(const flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>& names,
                  const NameList& list) {
    std::set<std::string_view> seen;
    for (flatbuffers::uoffset_t n = list.begin; n < names.size() && !offence_.found(); ++n) {
      const std::string_view name = names.Get(n)->string_view();
      offence_.require(!name.empty() && seen.insert(name).second,
                       fmt::format("{}[{}]", list.field, n),
                       "is empty or a repeated name, expected each {}'s own", list.owner);
    }
  }

  void checkJointNames() {
    if (offence_.found()) return;
    const std::string_view root = robot_.joint_names()->Get(0)->string_view();
    offence_.require(root.empty(), "joint_names[0]",
                     "is '{}', expected none: the root has no joint", root);
    checkNames(*robot_.joint_names(), {.field = "joint_names", .owner = "joint", .begin = 1});
  }

  void checkPositions() {
    for (flatbuffers::uoffset_t n = 0; n < positions() && !offence_.found(); ++n) {
      const schema::PositionLimits& limits = *robot_.limits()->Get(n);
      const float start = robot_.start_positions()->Get(n);
      const bool numbers = std::isfinite(limits.lower()) && std::isfinite(limits.upper());
      offence_.require(numbers && limits.lower() <= limits.upper(), fmt::format("limits[{}]", n),
                       "are {} to {}, expected finite ascending limits", limits.lower(),
                       limits.upper());
      offence_.require(start >= limits.lower() && start <= limits.upper(),
                       fmt::format("start_positions[{}]", n), "is {}, expected {} to {}", start,
                       limits.lower(), limits.upper());
      offence_.require(isAngle(start), fmt::format("start_positions[{}]", n),
                       "is {}, expected up to {}", start, kMostAngle);
    }
  }

  void checkGroups() {
    std::set<std::uint32_t> grouped;
    std::size_t next_sphere = 0;
    for (flatbuffers::uoffset_t n = 0; n < robot_.groups()->size() && !offence_.found(); ++n) {
      const schema::SphereGroup& group = *robot_.groups()->Get(n);
      const std::string field = fmt::format("groups[{}]", n);
      checkMembers(group, field, grouped);
      offence_.require(n == 0 || robot_.groups()->Get(n - 1)->link() < group.link(),
                       field + ".link", "does not ascend, expected ascending links");
      offence_.require(group.first_sphere() == next_sphere &&
                           group.sphere_count() <= robot_.spheres()->size() - next_sphere,
                       field + ".first_sphere",
                       "and count are {} and {}, expected {} and at most {}", group.first_sphere(),
                       group.sphere_count(), next_sphere, robot_.spheres()->size() - next_sphere);
      if (offence_.found()) return;
      const SphereRange range{next_sphere, next_sphere + group.sphere_count()};
      offence_.require(
          checkSpheres(*robot_.spheres(), range, robot_.radii()->size(), offence_.where()));
      next_sphere = range.end;
      if (group.statistics() == nullptr) continue;
      offence_.require(checkSphereStatistics(*group.statistics(),
                                             offence_.where() + "." + field + ".statistics"));
    }
    offence_.require(next_sphere == robot_.spheres()->size(), "spheres",
                     "has {} elements, expected the {} that the groups name",
                     robot_.spheres()->size(), next_sphere);
    offence_.require(grouped.size() == links(), "groups",
                     "name {} links, expected all {}, each once", grouped.size(), links());
  }

  void checkMembers(const schema::SphereGroup& group, const std::string& field,
                    std::set<std::uint32_t>& grouped) {
    const auto& members = *group.links();
    offence_.require(members.size() >= 1 && members.Get(0) == group.link(), field + ".links",
                     "does not begin with link {}, expected the group's own link first",
                     group.link());
    for (flatbuffers::uoffset_t n = 0; n < members.size() && !offence_.found(); ++n) {
      const std::uint32_t link = members.Get(n);
      offence_.require(link < links() && grouped.insert(link).second,
                       fmt::format("{}.links[{}]", field, n),
                       "is {}, expected one of {} links that is in no other group", link, links());
      if (n == 0) continue;
      offence_.require(members.Get(n - 1) < link, fmt::format("{}.links[{}]", field, n),
                       "is {} after {}, expected ascending links", link, members.Get(n - 1));
    }
  }

  void checkPairs() {
    std::tuple<int, int> previous{-1, -1};
    for (flatbuffers::uoffset_t n = 0; n < robot_.group_pairs()->size() && !offence_.found(); ++n) {
      const schema::GroupPair& pair = *robot_.group_pairs()->Get(n);
      const std::string field = fmt::format("group_pairs[{}]", n);
      const std::tuple<int, int> groups{pair.first(), pair.second()};
      offence_.require(pair.first() < pair.second() && pair.second() < robot_.groups()->size(),
                       field, "is ({}, {}), expected two ascending groups of {}", pair.first(),
                       pair.second(), robot_.groups()->size());
      offence_.require(groups > previous, field, "does not ascend, expected each pair once");
      offence_.require(pair.kind() <= schema::PairKind::MAX, field + ".kind",
                       "is {}, expected a value up to {}", static_cast<unsigned>(pair.kind()),
                       static_cast<unsigned>(schema::PairKind::MAX));
      previous = groups;
    }
  }

  void checkControlledJoints() {
    const auto& joints = *robot_.controlled_joints();
    std::vector<bool> controlled(positions());
    for (flatbuffers::uoffset_t n = 0; n < joints.size() && !offence_.found(); ++n) {
      const schema::ControlledJoint& joint = *joints.Get(n);
      const std::string field = fmt::format("controlled_joints[{}]", n);
      offence_.require(joint.position() < positions(), field + ".position",
                       "is {}, expected one of {} positions", joint.position(), positions());
      if (offence_.found()) return;
      offence_.require(!controlled[joint.position()], field + ".position",
                       "is {} again, expected each position once", joint.position());
      controlled[joint.position()] = true;
      offence_.require(joint.step() > 0 && joint.step() <= kMostStep, field + ".step",
                       "is {}, expected a number above 0 and up to {}", joint.step(), kMostStep);
      if (offence_.found()) return;
      const schema::PositionLimits& limits = *robot_.limits()->Get(joint.position());
      offence_.require(joint.lower() >= limits.lower() && joint.lower() <= joint.upper() &&
                           joint.upper() <= limits.upper(),
                       field + ".lower", "and upper are {} and {}, expected ascending, in {} to {}",
                       joint.lower(), joint.upper(), limits.lower(), limits.upper());
      // The limits of unlimited joints are the largest floats, but a position clamped to them must
      // be a number that can be computed with.
      offence_.require(joint.lower() <= kMostAngle && joint.upper() >= -kMostAngle,
                       field + ".lower", "and upper are {} and {}, expected some of -{} to {}",
                       joint.lower(), joint.upper(), kMostAngle, kMostAngle);
    }
  }

  void requireLink(std::uint32_t link, const char* field) {
    offence_.require(link < links(), field, "is {}, expected one of {} links", link, links());
  }

  void checkTools() {
    if (const schema::EndEffector* effector = robot_.end_effector()) {
      requireLink(effector->link(), "end_effector.link");
      offence_.require(effector->grasp_point() != nullptr && isPlace(*effector->grasp_point()),
                       "end_effector.grasp_point",
                       "is missing, farther than {} m or not finite, expected coordinates",
                       kFarthest);
      offence_.require(isLength(effector->grasp_radius()), "end_effector.grasp_radius",
                       "is {} m, expected a length above 0 and up to {} m",
                       effector->grasp_radius(), kFarthest);
    }
    if (const schema::Camera* camera = robot_.camera()) {
      // The tangents of half these angles, and their inverses, are valid lengths.
      constexpr float kLeastView = 0.001F;
      constexpr float kMostView = 3.14F;
      requireLink(camera->link(), "camera.link");
      offence_.require(
          camera->link_from_camera() != nullptr && isRigid(*camera->link_from_camera()),
          "camera.link_from_camera", "is missing or not a rigid transform, expected a pose");
      offence_.require(camera->vertical_fov() >= kLeastView && camera->vertical_fov() <= kMostView,
                       "camera.vertical_fov", "is {} rad, expected {} to {}",
                       camera->vertical_fov(), kLeastView, kMostView);
    }
    if (const schema::Base* base = robot_.base()) checkBase(*base);
    if (const schema::Laser* laser = robot_.laser()) checkLaser(*laser);
  }

  void checkLaser(const schema::Laser& laser) {
    // A whole turn in radians, rounded up.
    constexpr float kTurn = 6.2831855F;
    requireLink(laser.link(), "laser.link");
    offence_.require(laser.link_from_laser() != nullptr && isRigid(*laser.link_from_laser()),
                     "laser.link_from_laser",
                     "is missing or not a rigid transform, expected a pose");
    offence_.require(laser.field_of_view() >= 0 && laser.field_of_view() <= kTurn,
                     "laser.field_of_view", "is {} rad, expected 0 to 2 pi", laser.field_of_view());
    offence_.require(isLength(laser.range()), "laser.range",
                     "is {} m, expected a length above 0 and up to {} m", laser.range(), kFarthest);
    offence_.require(laser.least_range() >= 0 && laser.least_range() < laser.range(),
                     "laser.least_range", "is {} m, expected 0 to less than the range",
                     laser.least_range());
    offence_.require(laser.noise() >= 0 && isCoordinate(laser.noise()), "laser.noise",
                     "is {} m, expected 0 to {} m", laser.noise(), kFarthest);
  }

  void checkBase(const schema::Base& base) {
    const auto is_step = [](float step) { return step > 0 && step <= kFarthest; };
    offence_.require(is_step(base.forward_step()) && is_step(base.turn_step()), "base.forward_step",
                     "or turn_step is {} or {}, expected numbers above 0 and up to {}",
                     base.forward_step(), base.turn_step(), kFarthest);
    offence_.require(base.sideways_step() >= 0 && base.sideways_step() <= kFarthest,
                     "base.sideways_step", "is {} m, expected 0 to {} m", base.sideways_step(),
                     kFarthest);
    offence_.require(isCoordinate(base.root_height()), "base.root_height",
                     "is {} m, expected up to {} m", base.root_height(), kFarthest);
    const schema::Vec3* min = base.footprint_min();
    const schema::Vec3* max = base.footprint_max();
    const bool rectangle = min != nullptr && max != nullptr && isPlace(*min) && isPlace(*max) &&
                           min->x() <= max->x() && min->z() <= max->z();
    offence_.require(
        rectangle, "base.footprint_min",
        "or footprint_max is missing, not finite or not ascending, expected a rectangle");
    offence_.require(base.footprint_radius() >= 0 && isCoordinate(base.footprint_radius()),
                     "base.footprint_radius", "is {} m, expected 0 to {} m",
                     base.footprint_radius(), kFarthest);
  }

  void checkSurfaces() {
    const auto& surfaces = *robot_.surfaces();
    for (flatbuffers::uoffset_t n = 0; n < surfaces.size() && !offence_.found(); ++n) {
      const schema::LinkSurface& surface = *surfaces.Get(n);
      const std::string field = fmt::format("surfaces[{}]", n);
      const bool ascending = n == 0 || surfaces.Get(n - 1)->link() < surface.link();
      offence_.require(surface.link() < links() && ascending, field + ".link",
                       "is {}, expected ascending links below {}", surface.link(), links());
      const std::string where = offence_.where() + "." + field;
      if (surface.collision() != nullptr) {
        offence_.require(checkSurface(*surface.collision(), where + ".collision"));
      }
      if (surface.visual() != nullptr) {
        offence_.require(checkSurface(*surface.visual(), where + ".visual"));
      }
    }
  }

  const schema::Robot& robot_;
  Offence offence_;
};

}  // namespace

Result<void> checkRobot(const schema::Robot& robot, const std::string& where) {
  return RobotChecker(robot, where).run();
}

}  // namespace galactic::detail
