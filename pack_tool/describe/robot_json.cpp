#include <fmt/format.h>

#include <array>
#include <limits>
#include <string>

#include "galactic/position_names.h"
#include "galactic/robot.h"
#include "pack_tool/describe/asset_json.h"
#include "pack_tool/describe/json_parts.h"

namespace galactic::pack_tool {

namespace {

/// By the values of schema::JointType and schema::PairKind.
constexpr std::array<const char*, 6> kJointTypes{"fixed",     "revolute", "continuous",
                                                 "prismatic", "planar",   "floating"};
constexpr std::array<const char*, 5> kPairKinds{"tested", "adjacent", "always", "never", "ignored"};

template <class Names, class Value>
std::string nameOf(const Names& names, Value value) {
  const auto index = static_cast<std::size_t>(value);
  return index < names.size() ? names[index] : fmt::format("unknown ({})", index);
}

/// Null where there is no limit.
Json describeLimit(float limit) {
  constexpr float kUnlimited = std::numeric_limits<float>::max();
  if (limit == kUnlimited || limit == -kUnlimited) return nullptr;
  return jsonNumber(limit);
}

/// Describes one robot; knows the names of links and positions.
class RobotDescription {
 public:
  RobotDescription(const schema::Robot& stored, const Robot& robot)
      : stored_(stored), robot_(robot), positions_(positionNames(robot)) {}

  [[nodiscard]] Json describe() const {
    Json json;
    json["name"] = stored_.name()->str();
    json["radii"] = describeRadii(*stored_.radii());
    json["links"] = describeLinks();
    json["positions"] = describePositions();
    json["controlled_joints"] = describeControlled();
    json["end_effector"] = describeEndEffector();
    json["camera"] = describeCamera();
    json["base"] = describeBase();
    json["laser"] = describeLaser();
    json["groups"] = describeGroups();
    json["group_pairs"] = describePairs();
    json["surfaces"] = describeSurfaces();
    return json;
  }

 private:
  [[nodiscard]] Json linkName(std::size_t link) const { return std::string(robot_.linkName(link)); }

  [[nodiscard]] Json describeLinks() const {
    Json list = Json::array();
    for (std::size_t n = 0; n < robot_.links().size(); ++n) {
      const LinkFrame& link = robot_.links()[n];
      const auto index = static_cast<flatbuffers::uoffset_t>(n);
      const bool root = link.parent < 0;
      Json json;
      json["name"] = linkName(n);
      json["parent"] = root ? Json() : linkName(static_cast<std::size_t>(link.parent));
      json["joint"] = root ? Json() : Json(std::string(robot_.jointName(n)));
      json["type"] = nameOf(kJointTypes, link.type);
      json["position"] =
          link.position < 0 ? Json() : Json(positions_[static_cast<std::size_t>(link.position)]);
      json["multiplier"] = jsonNumber(link.multiplier);
      json["offset"] = jsonNumber(link.offset);
      json["parent_from_joint"] = describePose(stored_.links()->Get(index)->parent_from_joint());
      json["axis"] = describePoint(link.axis);
      list.push_back(std::move(json));
    }
    return list;
  }

  [[nodiscard]] Json describePositions() const {
    Json list = Json::array();
    for (std::size_t n = 0; n < positions_.size(); ++n) {
      list.push_back({{"name", positions_[n]},
                      {"lower", describeLimit(robot_.limits()[n].lower)},
                      {"upper", describeLimit(robot_.limits()[n].upper)},
                      {"start", jsonNumber(robot_.startPositions()[n])}});
    }
    return list;
  }

  [[nodiscard]] Json describeControlled() const {
    Json list = Json::array();
    for (const ControlledJoint& joint : robot_.controlledJoints()) {
      list.push_back({{"name", positions_[joint.position]},
                      {"step", jsonNumber(joint.step)},
                      {"lower", describeLimit(joint.lower)},
                      {"upper", describeLimit(joint.upper)}});
    }
    return list;
  }

  [[nodiscard]] Json describeEndEffector() const {
    const auto& effector = robot_.endEffector();
    if (!effector) return nullptr;
    return {{"link", linkName(effector->link)},
            {"grasp_point", describePoint(effector->grasp_point)},
            {"grasp_radius", jsonNumber(effector->grasp_radius)}};
  }

  [[nodiscard]] Json describeCamera() const {
    const schema::Camera* camera = stored_.camera();
    if (camera == nullptr) return nullptr;
    return {{"link", linkName(camera->link())},
            {"link_from_camera", describePose(*camera->link_from_camera())},
            {"vertical_fov", jsonNumber(camera->vertical_fov())}};
  }

  [[nodiscard]] Json describeBase() const {
    const auto& base = robot_.base();
    if (!base) return nullptr;
    return {{"forward_step", jsonNumber(base->forward_step)},
            {"turn_step", jsonNumber(base->turn_step)},
            {"sideways_step", jsonNumber(base->sideways_step)},
            {"root_height", jsonNumber(base->root_height)},
            {"footprint_min", describePoint(base->footprint_min)},
            {"footprint_max", describePoint(base->footprint_max)},
            {"footprint_radius", jsonNumber(base->footprint_radius)}};
  }

  [[nodiscard]] Json describeLaser() const {
    const schema::Laser* laser = stored_.laser();
    if (laser == nullptr) return nullptr;
    return {{"link", linkName(laser->link())},
            {"link_from_laser", describePose(*laser->link_from_laser())},
            {"field_of_view", jsonNumber(laser->field_of_view())},
            {"least_range", jsonNumber(laser->least_range())},
            {"range", jsonNumber(laser->range())},
            {"noise", jsonNumber(laser->noise())}};
  }

  [[nodiscard]] Json describeGroups() const {
    Json list = Json::array();
    for (const schema::SphereGroup* group : *stored_.groups()) {
      Json json;
      json["name"] = linkName(group->link());
      json["links"] = Json::array();
      for (const std::uint32_t link : *group->links()) json["links"].push_back(linkName(link));
      json["spheres"] = describeSpheres(
          *stored_.spheres(), {group->first_sphere(), group->sphere_count()}, *stored_.radii());
      json["sphere_quality"] = describeQuality(group->statistics());
      list.push_back(std::move(json));
    }
    return list;
  }

  /// How many pairs of each kind, and their names: of the tested ones too many to list.
  [[nodiscard]] Json describePairs() const {
    std::array<Json, kPairKinds.size()> pairs;
    pairs.fill(Json::array());
    for (const schema::GroupPair* pair : *stored_.group_pairs()) {
      const auto kind = static_cast<std::size_t>(pair->kind());
      if (kind >= pairs.size()) continue;
      pairs[kind].push_back(Json::array({groupName(pair->first()), groupName(pair->second())}));
    }
    Json json;
    for (std::size_t kind = 0; kind < pairs.size(); ++kind) {
      json[kPairKinds[kind]] = std::move(pairs[kind]);
    }
    return json;
  }

  [[nodiscard]] Json groupName(std::size_t group) const {
    return linkName(robot_.groups()[group].link);
  }

  [[nodiscard]] Json describeSurfaces() const {
    Json list = Json::array();
    for (const schema::LinkSurface* surface : *stored_.surfaces()) {
      list.push_back({{"name", linkName(surface->link())},
                      {"collision", describeSurface(surface->collision())},
                      {"visual", describeSurface(surface->visual())}});
    }
    return list;
  }

  const schema::Robot& stored_;
  const Robot& robot_;
  std::vector<std::string> positions_;
};

}  // namespace

Json describeRobot(const PackFile& pack) {
  const auto robot = Robot::from(pack);
  if (!robot) return nullptr;
  return RobotDescription(*pack.root().asset_as_Robot(), *robot).describe();
}

}  // namespace galactic::pack_tool
