// A URDF written as an MJCF, element by element, is the same robot.
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <map>

#include "bake/robot_description/link_points.h"
#include "bake/robot_description/mjcf/mjcf_texts.h"
#include "galactic/bake/robot_baker.h"
#include "galactic/bake/robot_recipe.h"
#include "robot_description/mjcf/xml_tree.h"
#include "support/build_paths.h"

namespace galactic::test::mjcf::same_robot_test {
namespace {

using bake::XmlElement;
using testing::DoubleNear;
using testing::Pointwise;

/// Angles become sines and cosines by two ways.
constexpr double kRounding = 1e-12;

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

const XmlElement* childOf(const XmlElement& element, std::string_view name) {
  for (const XmlElement& child : element.children) {
    if (child.name == name) return &child;
  }
  return nullptr;
}

std::string valueOf(const XmlElement* element, std::string_view attribute,
                    std::string_view fallback = "") {
  const std::string* value = element == nullptr ? nullptr : element->find(attribute);
  return std::string(value == nullptr ? fallback : *value);
}

/// Writes a URDF of primitives as an MJCF whose angles are turned about fixed axes, as URDF does.
class Converter {
 public:
  explicit Converter(const XmlElement& urdf) : urdf_(urdf) {
    for (const XmlElement& element : urdf.children) {
      if (element.name == "material") {
        colors_[valueOf(&element, "name")] = valueOf(childOf(element, "color"), "rgba");
      }
      if (element.name == "link") links_[valueOf(&element, "name")] = &element;
      if (element.name == "joint") joints_.push_back(&element);
    }
  }

  [[nodiscard]] std::string text() const {
    std::string text = fmt::format(
        "<mujoco model='{}'><compiler angle='radian' eulerseq='XYZ'/>"
        "<default><default class='visual'><geom contype='0' conaffinity='0' group='2'/></default>"
        "<default class='collision'><geom group='3'/></default></default><asset>",
        valueOf(&urdf_, "name"));
    for (const auto& [name, color] : colors_) {
      text += fmt::format("<material name='{}' rgba='{}'/>", name, color);
    }
    text += "</asset><worldbody>" + bodyText(rootName(), nullptr) + "</worldbody><equality>";
    for (const XmlElement* joint : joints_) {
      const XmlElement* mimic = childOf(*joint, "mimic");
      if (mimic == nullptr) continue;
      text += fmt::format("<joint joint1='{}' joint2='{}' polycoef='{} {} 0 0 0'/>",
                          valueOf(joint, "name"), valueOf(mimic, "joint"),
                          valueOf(mimic, "offset", "0"), valueOf(mimic, "multiplier", "1"));
    }
    return text + "</equality></mujoco>";
  }

 private:
  [[nodiscard]] std::string rootName() const {
    for (const auto& [name, unused] : links_) {
      const bool is_child = std::ranges::any_of(joints_, [&](const XmlElement* joint) {
        return valueOf(childOf(*joint, "child"), "link") == name;
      });
      if (!is_child) return name;
    }
    return {};
  }

  static std::string originText(const XmlElement& element) {
    const XmlElement* origin = childOf(element, "origin");
    return fmt::format("pos='{}' euler='{}'", valueOf(origin, "xyz", "0 0 0"),
                       valueOf(origin, "rpy", "0 0 0"));
  }

  static std::string jointText(const XmlElement& joint) {
    const std::string type = valueOf(&joint, "type");
    if (type == "fixed") return {};
    std::string text = fmt::format("<joint name='{}' type='{}' axis='{}'", valueOf(&joint, "name"),
                                   type == "prismatic" ? "slide" : "hinge",
                                   valueOf(childOf(joint, "axis"), "xyz", "1 0 0"));
    if (type != "continuous") {
      const XmlElement* limit = childOf(joint, "limit");
      text +=
          fmt::format(" range='{} {}'", valueOf(limit, "lower", "0"), valueOf(limit, "upper", "0"));
    }
    return text + "/>";
  }

  [[nodiscard]] std::string geomText(const XmlElement& element) const {
    const XmlElement& shape = childOf(element, "geometry")->children.front();
    std::string size;
    if (shape.name == "box") {
      std::array<double, 3> sides{};
      std::istringstream(valueOf(&shape, "size")) >> sides[0] >> sides[1] >> sides[2];
      size = fmt::format("{} {} {}", sides[0] / 2, sides[1] / 2, sides[2] / 2);
    } else if (shape.name == "cylinder") {
      size =
          fmt::format("{} {}", valueOf(&shape, "radius"), std::stod(valueOf(&shape, "length")) / 2);
    } else {
      size = valueOf(&shape, "radius");
    }
    std::string text = fmt::format("<geom class='{}' type='{}' size='{}' {}", element.name,
                                   shape.name, size, originText(element));
    const XmlElement* material = childOf(element, "material");
    if (material != nullptr) {
      const XmlElement* own = childOf(*material, "color");
      text += own == nullptr ? fmt::format(" material='{}'", valueOf(material, "name"))
                             : fmt::format(" rgba='{}'", valueOf(own, "rgba"));
    }
    return text + "/>";
  }

  [[nodiscard]] std::string bodyText(const std::string& name, const XmlElement* joint) const {
    std::string text =
        fmt::format("<body name='{}' {}>", name, joint == nullptr ? "" : originText(*joint));
    text += joint == nullptr ? "<freejoint/>" : jointText(*joint);
    for (const XmlElement& element : links_.at(name)->children) {
      if (element.name == "visual" || element.name == "collision") text += geomText(element);
    }
    for (const XmlElement* below : joints_) {
      if (valueOf(childOf(*below, "parent"), "link") != name) continue;
      text += bodyText(valueOf(childOf(*below, "child"), "link"), below);
    }
    return text + "</body>";
  }

  const XmlElement& urdf_;
  std::map<std::string, std::string> colors_;
  std::map<std::string, const XmlElement*> links_;
  std::vector<const XmlElement*> joints_;
};

/// A robot of packs/, as its URDF and as the MJCF of it.
struct Twins {
  bake::SourceRobot urdf;
  bake::SourceRobot mjcf;
};

Twins twinsOf(const ScratchFolder& folder, const std::string& file) {
  const auto path = sourceFolder() / "packs" / file;
  const auto tree = bake::parseXml(contentOf(path), file);
  EXPECT_TRUE(tree.has_value());
  auto urdf = bake::importRobot(path);
  EXPECT_TRUE(urdf.has_value());
  return {std::move(*urdf), mjcfRobot(folder, Converter(*tree).text())};
}

void expectSameShapes(const std::vector<bake::LinkShape>& a, const std::vector<bake::LinkShape>& b,
                      bool with_colors) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    EXPECT_EQ(a[n].geometry.index(), b[n].geometry.index());
    EXPECT_THAT(a[n].link_from_shape, Pointwise(DoubleNear(kRounding), b[n].link_from_shape));
    if (const auto* box = std::get_if<bake::BoxShape>(&a[n].geometry)) {
      EXPECT_THAT(box->size,
                  Pointwise(DoubleNear(kRounding), std::get<bake::BoxShape>(b[n].geometry).size));
    }
    if (const auto* rod = std::get_if<bake::CylinderShape>(&a[n].geometry)) {
      const auto& other = std::get<bake::CylinderShape>(b[n].geometry);
      EXPECT_NEAR(rod->radius, other.radius, kRounding);
      EXPECT_NEAR(rod->length, other.length, kRounding);
    }
    if (const auto* ball = std::get_if<bake::SphereShape>(&a[n].geometry)) {
      EXPECT_NEAR(ball->radius, std::get<bake::SphereShape>(b[n].geometry).radius, kRounding);
    }
    if (!with_colors) continue;
    ASSERT_EQ(a[n].color.has_value(), b[n].color.has_value());
    // The URDF's parser reads floats.
    if (a[n].color) {
      EXPECT_THAT(*a[n].color, Pointwise(testing::FloatNear(1e-6F), *b[n].color));
    }
  }
}

class SameRobots : public testing::TestWithParam<const char*> {};

TEST_P(SameRobots, HaveTheSameLinksJointsAndShapes) {
  const ScratchFolder folder;
  const auto [urdf, mjcf] = twinsOf(folder, GetParam());
  EXPECT_EQ(urdf.name, mjcf.name);
  ASSERT_EQ(urdf.links.size(), mjcf.links.size());
  ASSERT_GT(urdf.links.size(), 3U);
  for (std::size_t n = 0; n < urdf.links.size(); ++n) {
    const bake::SourceLink& a = urdf.links[n];
    const bake::SourceLink& b = mjcf.links[n];
    SCOPED_TRACE(a.name);
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.parent, b.parent);
    EXPECT_EQ(a.joint_type, b.joint_type);
    // MJCF has no joints where nothing moves.
    if (a.joint_type != JointType::kFixed) {
      EXPECT_EQ(a.joint_name, b.joint_name);
    }
    EXPECT_THAT(a.parent_from_joint, Pointwise(DoubleNear(kRounding), b.parent_from_joint));
    EXPECT_THAT(a.axis, Pointwise(DoubleNear(kRounding), b.axis));
    ASSERT_EQ(a.limits.has_value(), b.limits.has_value());
    if (a.limits) {
      EXPECT_EQ(a.limits->lower, b.limits->lower);
      EXPECT_EQ(a.limits->upper, b.limits->upper);
    }
    ASSERT_EQ(a.mimic.has_value(), b.mimic.has_value());
    if (a.mimic) {
      EXPECT_EQ(a.mimic->link, b.mimic->link);
      EXPECT_EQ(a.mimic->multiplier, b.mimic->multiplier);
      EXPECT_EQ(a.mimic->offset, b.mimic->offset);
    }
    expectSameShapes(a.visuals, b.visuals, true);
    expectSameShapes(a.collisions, b.collisions, false);
  }
}

TEST_P(SameRobots, BakeToTheSamePacksWithTheRecipeOfOne) {
  const ScratchFolder folder;
  const std::string file = GetParam();
  const auto twins = twinsOf(folder, file);
  const std::string recipe_file =
      file.find("porter") == std::string::npos ? "golden/arm.toml" : "sample/robot/robot.toml";
  const auto recipe = bake::readRobotRecipe(sourceFolder() / "packs" / recipe_file);
  ASSERT_TRUE(recipe.has_value()) << recipe.error().text();
  bake::RobotBakeOptions options;
  // Few large spheres.
  options.radii = {0.04F, 0.12F};
  options.eps = 0.03F;
  options.tau = 0.05F;
  const auto a = bake::bakeRobot(twins.urdf, &*recipe, options);
  const auto b = bake::bakeRobot(twins.mjcf, &*recipe, options);
  ASSERT_TRUE(a.has_value()) << a.error().text();
  ASSERT_TRUE(b.has_value()) << b.error().text();
  ASSERT_EQ(a->kinematics.links.size(), b->kinematics.links.size());
  for (std::size_t n = 0; n < a->kinematics.links.size(); ++n) {
    const Pose& p = a->kinematics.links[n].parent_from_joint;
    const Pose& q = b->kinematics.links[n].parent_from_joint;
    EXPECT_NEAR(p.translation.x, q.translation.x, 1e-6F);
    EXPECT_NEAR(p.translation.y, q.translation.y, 1e-6F);
    EXPECT_NEAR(p.translation.z, q.translation.z, 1e-6F);
    EXPECT_NEAR(std::abs(p.rotation.x * q.rotation.x + p.rotation.y * q.rotation.y +
                         p.rotation.z * q.rotation.z + p.rotation.w * q.rotation.w),
                1, 1e-6F);
    ASSERT_EQ(a->collision_surfaces[n].positions.size(), b->collision_surfaces[n].positions.size());
    EXPECT_EQ(a->visual_surfaces[n].colors, b->visual_surfaces[n].colors);
    for (std::size_t k = 0; k < a->collision_surfaces[n].positions.size(); ++k) {
      const Vec3 off =
          a->collision_surfaces[n].positions[k] - b->collision_surfaces[n].positions[k];
      ASSERT_LT(dot(off, off), 1e-12F);
    }
  }
  EXPECT_EQ(a->kinematics.start_positions, b->kinematics.start_positions);
  EXPECT_EQ(a->controlled_joints.size(), b->controlled_joints.size());
  ASSERT_EQ(a->groups.size(), b->groups.size());
  for (std::size_t n = 0; n < a->groups.size(); ++n) {
    EXPECT_EQ(a->groups[n].spheres.spheres.size(), b->groups[n].spheres.spheres.size());
  }
}

INSTANTIATE_TEST_SUITE_P(OfThePacks, SameRobots,
                         testing::Values("sample/robot/porter.urdf", "golden/arm.urdf"),
                         [](const auto& one) {
                           return std::string(one.index == 0 ? "Porter" : "Arm");
                         });

}  // namespace
}  // namespace galactic::test::mjcf::same_robot_test
