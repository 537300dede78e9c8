#include "robot_description/urdf/urdf_reader.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <tinyxml.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <exception>
#include <optional>
#include <string_view>
#include <utility>

#include "import/affine.h"
#include "robot_description/urdf/urdf_reader_text.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// Collects the parser's log messages; prints nothing.
class LogCapture final : public console_bridge::OutputHandler {
 public:
  LogCapture() {
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_WARN);
    console_bridge::useOutputHandler(this);
  }
  ~LogCapture() override { console_bridge::restorePreviousOutputHandler(); }
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;
  LogCapture(LogCapture&&) = delete;
  LogCapture& operator=(LogCapture&&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/,
           int /*line*/) override {
    auto& list = level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR ? errors_ : warnings_;
    if (list.size() < kMostMessages) list.push_back(text);
  }

  /// All errors, joined to one sentence.
  [[nodiscard]] std::string errors() const {
    std::string reasons;
    for (std::string_view error : errors_) {
      // This message follows every error of a joint or link, and says nothing.
      if (error.ends_with("xml is not initialized correctly")) continue;
      while (error.ends_with('.')) error.remove_suffix(1);
      reasons += fmt::format("{}{}", reasons.empty() ? "" : "; ", error);
    }
    return fmt::format("the URDF parser refuses it: {}",
                       reasons.empty() ? "no reason given" : reasons);
  }
  [[nodiscard]] bool hasErrors() const { return !errors_.empty(); }
  [[nodiscard]] std::vector<std::string> takeWarnings() { return std::move(warnings_); }

 private:
  static constexpr std::size_t kMostMessages = 20;
  std::vector<std::string> errors_;
  std::vector<std::string> warnings_;
};

/// The <robot> element, or an error that says what is wrong with the text.
Result<TiXmlElement*> robotElement(TiXmlDocument& document, const std::string& text,
                                   const std::string& where) {
  document.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  if (document.Error()) {
    const std::string place =
        document.ErrorRow() == 0 ? where : fmt::format("{}:{}", where, document.ErrorRow());
    std::string_view reason = document.ErrorDesc();
    while (reason.ends_with('.')) reason.remove_suffix(1);
    return fail(ErrorCode::kInvalidInput, place,
                fmt::format("it is not well-formed XML: {}; repair or generate it again", reason));
  }
  TiXmlElement* robot = document.FirstChildElement("robot");
  if (robot == nullptr) {
    const TiXmlElement* root = document.RootElement();
    return fail(
        ErrorCode::kInvalidInput, where,
        fmt::format("its outermost element is {}, expected <robot> (URDF) or <mujoco> (MJCF)",
                    root == nullptr ? "missing" : fmt::format("<{}>", root->Value())));
  }
  // The parser's library would ignore these elements, and their links would have no shape.
  for (TiXmlElement* e = robot; e != nullptr; e = nextElement(*e)) {
    if (std::string_view(e->Value()).starts_with("xacro:")) {
      return fail(ErrorCode::kUnsupported, fmt::format("{}:{}", where, e->Row()),
                  fmt::format("it is a xacro file, with <{}>; expand it with the xacro tool and "
                              "give the result",
                              e->Value()));
    }
  }
  return robot;
}

/// Names of the children of <robot> with this tag, in the order of the text: the parser's library
/// sorts them by name.
std::vector<std::string> namesInOrder(const TiXmlElement& robot, const char* tag) {
  std::vector<std::string> names;
  for (const auto* e = robot.FirstChildElement(tag); e != nullptr; e = e->NextSiblingElement(tag)) {
    const char* name = e->Attribute("name");
    names.emplace_back(name == nullptr ? "" : name);
  }
  return names;
}

Affine toAffine(const urdf::Pose& pose) {
  const auto& [x, y, z, w] =
      std::tie(pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w);
  const auto& p = pose.position;
  return {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),     p.x,
          2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),     p.y,
          2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y), p.z};
}

std::array<double, 3> toArray(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

DescribedShape toShape(const urdf::Pose& origin, const urdf::Geometry& geometry) {
  DescribedShape shape;
  shape.link_from_shape = toAffine(origin);
  switch (geometry.type) {
    case urdf::Geometry::BOX:
      shape.geometry = DescribedGeometry::kBox;
      shape.size = toArray(static_cast<const urdf::Box&>(geometry).dim);
      break;
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      shape.geometry = DescribedGeometry::kCylinder;
      shape.size = {cylinder.radius, cylinder.length, 0};
      break;
    }
    case urdf::Geometry::SPHERE:
      shape.geometry = DescribedGeometry::kSphere;
      shape.size = {static_cast<const urdf::Sphere&>(geometry).radius, 0, 0};
      break;
    case urdf::Geometry::MESH: {
      const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
      shape.geometry = DescribedGeometry::kMesh;
      shape.size = toArray(mesh.scale);
      shape.mesh = mesh.filename;
      break;
    }
  }
  return shape;
}

void addMaterial(DescribedShape& shape, const urdf::Material& material) {
  shape.texture = material.texture_filename;
  const urdf::Color& c = material.color;
  shape.color = {static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b),
                 static_cast<double>(c.a)};
  // The library does not distinguish a missing color from black; with a texture, it is missing.
  shape.has_color = shape.texture.empty() || c.r + c.g + c.b > 0;
}

/// The moments of an inertial along the axes of its link: R M R^T.
LinkInertial toInertial(const std::string& link, const urdf::Inertial& inertial) {
  const Affine turn = toAffine(inertial.origin);
  const std::array<std::array<double, 3>, 3> moments{{{inertial.ixx, inertial.ixy, inertial.ixz},
                                                      {inertial.ixy, inertial.iyy, inertial.iyz},
                                                      {inertial.ixz, inertial.iyz, inertial.izz}}};
  const auto along = [&](std::size_t i, std::size_t j) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t l = 0; l < 3; ++l) sum += turn[4 * i + k] * moments[k][l] * turn[4 * j + l];
    }
    return sum;
  };
  return {
      .link = link,
      .mass = inertial.mass,
      .center = toArray(inertial.origin.position),
      .moments = {along(0, 0), along(1, 1), along(2, 2), along(0, 1), along(0, 2), along(1, 2)}};
}

DescribedLink toLink(const urdf::Link& link) {
  DescribedLink converted;
  converted.name = link.name;
  for (const auto& visual : link.visual_array) {
    DescribedShape& shape =
        converted.visuals.emplace_back(toShape(visual->origin, *visual->geometry));
    if (visual->material) addMaterial(shape, *visual->material);
  }
  for (const auto& collision : link.collision_array) {
    converted.collisions.push_back(toShape(collision->origin, *collision->geometry));
  }
  if (link.inertial) converted.inertials.push_back(toInertial(link.name, *link.inertial));
  return converted;
}

std::optional<JointType> toJointType(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::FIXED:
      return JointType::kFixed;
    case urdf::Joint::REVOLUTE:
      return JointType::kRevolute;
    case urdf::Joint::CONTINUOUS:
      return JointType::kContinuous;
    case urdf::Joint::PRISMATIC:
      return JointType::kPrismatic;
    case urdf::Joint::PLANAR:
      return JointType::kPlanar;
    case urdf::Joint::FLOATING:
      return JointType::kFloating;
    default:
      return std::nullopt;
  }
}

DescribedJoint toJoint(const urdf::Joint& joint) {
  DescribedJoint converted;
  converted.name = joint.name;
  converted.parent = joint.parent_link_name;
  converted.child = joint.child_link_name;
  converted.type = toJointType(joint).value_or(JointType::kFixed);
  converted.parent_from_joint = toAffine(joint.parent_to_joint_origin_transform);
  converted.axis = toArray(joint.axis);
  if (joint.limits) {
    converted.has_limits = true;
    converted.lower = joint.limits->lower;
    converted.upper = joint.limits->upper;
  }
  if (joint.mimic) {
    converted.mimic = joint.mimic->joint_name;
    converted.multiplier = joint.mimic->multiplier;
    converted.offset = joint.mimic->offset;
  }
  return converted;
}

/// Returns the model that the parser's library makes of the prepared text.
Result<urdf::ModelInterfaceSharedPtr> parsedModel(const std::string& text, const std::string& where,
                                                  const LogCapture& log) {
  urdf::ModelInterfaceSharedPtr parsed;
  try {
    parsed = urdf::parseURDF(text);
  } catch (const std::exception& e) {
    return fail(ErrorCode::kInvalidInput, where, fmt::format("it cannot be read: {}", e.what()));
  }
  // The parser continues after some errors, with half of a link.
  if (!parsed || log.hasErrors()) return fail(ErrorCode::kInvalidInput, where, log.errors());
  return parsed;
}

}  // namespace

Result<RobotDescription> parseUrdf(const std::string& text, const std::string& where,
                                   DescriptionPart part) {
  TiXmlDocument document;
  const auto robot = robotElement(document, text, where);
  if (!robot) return tl::unexpected(robot.error());
  RobotDescription model;
  const ParserText prepared = textForParser(document, part, model.warnings);
  LogCapture log;
  ASSIGN_OR_RETURN(const auto parsed, parsedModel(prepared.text, where, log));
  model.name = parsed->name_;
  for (const std::string& name : namesInOrder(**robot, "link")) {
    if (const auto link = parsed->getLink(name)) model.links.push_back(toLink(*link));
  }
  for (const std::string& name : namesInOrder(**robot, "joint")) {
    const auto joint = parsed->getJoint(name);
    if (!joint) continue;
    DescribedJoint& converted = model.joints.emplace_back(toJoint(*joint));
    if (prepared.without_limits.contains(name)) converted.has_limits = false;
  }
  for (std::string& warning : log.takeWarnings()) model.warnings.push_back(std::move(warning));
  return model;
}

Result<std::vector<LinkSpheres>> parseSrdf(const std::string& text, const std::string& where) {
  TiXmlDocument document;
  ASSIGN_OR_RETURN(const auto robot, robotElement(document, text, where));
  std::vector<LinkSpheres> links;
  constexpr const char* kTag = "link_sphere_approximation";
  for (const auto* e = robot->FirstChildElement(kTag); e != nullptr;
       e = e->NextSiblingElement(kTag)) {
    const char* name = e->Attribute("link");
    if (name == nullptr) {
      return fail(ErrorCode::kInvalidInput, fmt::format("{}:{}", where, e->Row()),
                  fmt::format("<{}> has no attribute 'link'; name the link", kTag));
    }
    LinkSpheres& link = links.emplace_back();
    link.link = name;
    for (const auto* s = e->FirstChildElement("sphere"); s != nullptr;
         s = s->NextSiblingElement("sphere")) {
      const auto center = numbersOf(s->Attribute("center"), 3);
      const auto radius = numbersOf(s->Attribute("radius"), 1);
      if (!center || !radius) {
        return fail(ErrorCode::kInvalidInput, fmt::format("{}:{}", where, s->Row()),
                    fmt::format("a <sphere> of link '{}' needs center=\"x y z\" and "
                                "radius=\"r\"",
                                name));
      }
      link.spheres.push_back({{(*center)[0], (*center)[1], (*center)[2]}, (*radius)[0]});
    }
  }
  return links;
}

}  // namespace galactic::bake
