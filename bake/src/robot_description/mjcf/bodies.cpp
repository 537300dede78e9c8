#include "robot_description/mjcf/bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "import/affine.h"
#include "robot_description/frames.h"
#include "robot_description/mjcf/unique_name.h"

namespace galactic::bake {
namespace {

/// Elements that generate bodies.
constexpr std::array<std::string_view, 4> kMakers{"attach", "composite", "flexcomp", "replicate"};
/// Elements that do not describe how a robot is built.
constexpr std::array<std::string_view, 3> kPassedOver{"light", "plugin", "site"};

/// MuJoCo's cameras look along -Z, with X to the right and Y up.
constexpr Affine kCameraFromView{0, -1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0};

template <std::size_t kCount>
bool isIn(const std::array<std::string_view, kCount>& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

std::array<double, 3> rotated(const Affine& m, const std::array<double, 3>& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[4] * v[0] + m[5] * v[1] + m[6] * v[2],
          m[8] * v[0] + m[9] * v[1] + m[10] * v[2]};
}

/// The place of elements: in a body, or in <frame> elements inside one.
struct Surroundings {
  int body = -1;
  Affine body_from_here = kIdentityAffine;
  /// Class of elements that state none.
  std::string childclass;
};

class BodyReader {
 public:
  BodyReader(const MjcfDefaults& defaults, const MjcfSettings& settings, const MjcfAssets& assets,
             DescriptionPart part)
      : defaults_(defaults), settings_(settings), assets_(assets), part_(part) {}

  MjcfWorld read(const XmlElement& root) {
    collectNames(root);
    for (const XmlElement& section : root.children) {
      if (section.name == "worldbody") readContent(section, {});
    }
    return std::move(world_);
  }

 private:
  void collectNames(const XmlElement& element) {
    const std::string* name = element.find("name");
    if (name != nullptr && element.name == "body") body_names_.insert(*name);
    const bool is_joint = element.name == "joint" || element.name == "freejoint";
    if (name != nullptr && is_joint) joint_names_.insert(*name);
    for (const XmlElement& child : element.children) collectNames(child);
  }

  void readContent(const XmlElement& parent, const Surroundings& around) {
    for (const XmlElement& child : parent.children) {
      if (child.name == "body") {
        readBody(child, around);
      } else if (child.name == "frame") {
        readFrame(child, around);
      } else if (child.name == "geom") {
        addGeom(child, around);
      } else if (child.name == "joint" || child.name == "freejoint") {
        addJoint(child, around);
      } else if (child.name == "camera") {
        addCamera(child, around);
      } else if (child.name == "inertial") {
        setInertial(child, around);
      } else {
        passOver(child);
      }
    }
  }

  void passOver(const XmlElement& element) {
    MjcfFindings& findings = defaults_.findings();
    if (isIn(kMakers, element.name)) {
      findings.error(element.place,
                     fmt::format("<{}> makes bodies that the file does not have; save the model "
                                 "from MuJoCo (mj_saveLastXML), which writes them out, and give "
                                 "that file",
                                 element.name),
                     ErrorCode::kUnsupported);
    } else if (!isIn(kPassedOver, element.name)) {
      findings.warn(
          fmt::format("an element <{}> in a body is not known, and left out", element.name));
    }
  }

  static std::string childclassOf(const XmlElement& element, const Surroundings& around) {
    const std::string* own = element.find("childclass");
    return own == nullptr ? around.childclass : *own;
  }

  void readBody(const XmlElement& element, const Surroundings& around) {
    // Bodies have no class.
    const MjcfAttributes attributes = defaults_.attributesOf(element, "");
    if (attributes.flag("mocap", false)) return;
    MjcfBody body;
    body.name = attributes.text("name");
    if (body.name.empty()) {
      body.name = uniqueName(fmt::format("body_{}", world_.bodies.size() + 1), body_names_);
    }
    body.place = element.place;
    body.parent = around.body;
    body.parent_from_body = compose(around.body_from_here, poseOf(attributes, settings_));
    const auto index = static_cast<int>(world_.bodies.size());
    world_.bodies.push_back(std::move(body));
    readContent(element, {.body = index,
                          .body_from_here = kIdentityAffine,
                          .childclass = childclassOf(element, around)});
  }

  void readFrame(const XmlElement& element, const Surroundings& around) {
    const MjcfAttributes attributes = defaults_.attributesOf(element, "");
    readContent(element,
                {.body = around.body,
                 .body_from_here = compose(around.body_from_here, poseOf(attributes, settings_)),
                 .childclass = childclassOf(element, around)});
  }

  void addGeom(const XmlElement& element, const Surroundings& around) {
    if (around.body < 0) {
      ++world_.loose_geoms;
      return;
    }
    const auto geom = readGeom(defaults_.attributesOf(element, around.childclass),
                               around.body_from_here, assets_, settings_);
    if (geom) bodyOf(around).geoms.push_back(*geom);
  }

  void addCamera(const XmlElement& element, const Surroundings& around) {
    const MjcfAttributes camera = defaults_.attributesOf(element, around.childclass);
    const bool stays = !camera.has("mode") || camera.text("mode") == "fixed";
    if (around.body < 0 || !stays || camera.text("name").empty()) return;
    const Affine body_from_camera = compose(around.body_from_here, poseOf(camera, settings_));
    bodyOf(around).cameras.push_back(
        {camera.text("name"), compose(body_from_camera, kCameraFromView)});
  }

  void addJoint(const XmlElement& element, const Surroundings& around) {
    MjcfFindings& findings = defaults_.findings();
    if (around.body < 0) {
      return findings.error(element.place, fmt::format("<{}> is in no <body>; the world does not "
                                                       "move: put it into one",
                                                       element.name));
    }
    MjcfBody& body = bodyOf(around);
    const bool is_free = element.name == "freejoint";
    MjcfJoint joint = readJoint(defaults_.attributesOf(element, around.childclass), is_free);
    joint.anchor = transformed(around.body_from_here, joint.anchor);
    joint.axis = rotated(around.body_from_here, joint.axis);
    if (joint.name.empty()) joint.name = uniqueName(body.name + "_joint", joint_names_);
    if (joint.type == MjcfJointType::kFree && body.parent >= 0) {
      findings.error(element.place,
                     fmt::format("body '{}' is in another and has a free joint, which only bodies "
                                 "of the world may have; remove it, or take the body out",
                                 body.name));
    }
    body.joints.push_back(std::move(joint));
  }

  [[nodiscard]] MjcfJoint readJoint(const MjcfAttributes& attributes, bool is_free) const {
    constexpr std::array<std::string_view, 4> kTypes{"hinge", "slide", "ball", "free"};
    constexpr std::array<std::string_view, 3> kLimited{"false", "true", "auto"};
    MjcfJoint joint;
    joint.name = attributes.text("name");
    joint.type = is_free ? MjcfJointType::kFree
                         : static_cast<MjcfJointType>(attributes.choice("type", kTypes, 0));
    if (joint.type == MjcfJointType::kFree || joint.type == MjcfJointType::kBall) return joint;
    const bool turns = joint.type == MjcfJointType::kHinge;
    // For slides it does not matter which point the axis goes through.
    if (turns) joint.anchor = attributes.vector<3>("pos").value_or(joint.anchor);
    joint.axis = attributes.vector<3>("axis").value_or(joint.axis);
    const double length = std::hypot(joint.axis[0], joint.axis[1], joint.axis[2]);
    for (double& component : joint.axis) component /= length > 0 ? length : 1;
    const auto position = [&](double value) { return turns ? settings_.radians(value) : value; };
    joint.reference = position(attributes.number("ref", 0));
    const auto range = attributes.vector<2>("range").value_or(std::array<double, 2>{});
    const std::size_t limited = attributes.choice("limited", kLimited, 2);
    joint.is_limited =
        limited == 1 || (limited == 2 && settings_.auto_limits && range[0] < range[1]);
    joint.lower = position(range[0]);
    joint.upper = position(range[1]);
    return joint;
  }

  void setInertial(const XmlElement& element, const Surroundings& around) {
    const bool counts = settings_.inertias != MjcfSettings::Inertias::kFromShapes;
    if (part_ != DescriptionPart::kMasses || !counts || around.body < 0) return;
    const MjcfAttributes attributes = defaults_.attributesOf(element, around.childclass);
    const Affine frame = compose(around.body_from_here, poseOf(attributes, settings_));
    LinkInertial inertial;
    inertial.mass = attributes.number("mass", 0);
    inertial.center = {frame[3], frame[7], frame[11]};
    if (const auto full = attributes.vector<6>("fullinertia")) {
      inertial.moments = momentsAlong(frame, *full);
    } else if (const auto diagonal = attributes.vector<3>("diaginertia")) {
      const auto& [x, y, z] = *diagonal;
      inertial.moments = momentsAlong(frame, {x, y, z, 0, 0, 0});
    }
    bodyOf(around).inertial = inertial;
  }

  MjcfBody& bodyOf(const Surroundings& around) {
    return world_.bodies[static_cast<std::size_t>(around.body)];
  }

  const MjcfDefaults& defaults_;
  const MjcfSettings& settings_;
  const MjcfAssets& assets_;
  DescriptionPart part_;
  MjcfWorld world_;
  NameSet body_names_;
  NameSet joint_names_;
};

}  // namespace

MjcfWorld readBodies(const XmlElement& root, const MjcfDefaults& defaults,
                     const MjcfSettings& settings, const MjcfAssets& assets, DescriptionPart part) {
  return BodyReader(defaults, settings, assets, part).read(root);
}

}  // namespace galactic::bake
