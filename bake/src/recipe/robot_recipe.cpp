#include "galactic/bake/robot_recipe.h"

#include <cmath>
#include <numbers>
#include <set>

#include "import/affine.h"
#include "support/try.h"
#include "toml/recipe_table.h"
#include "urdf/urdf_frames.h"

namespace galactic::bake {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;
constexpr NumberRange kCoordinate{-10, 10, "m"};
constexpr NumberRange kRadius{0.001, 2, "m"};
constexpr NumberRange kTolerance{0.001, 1, "m"};
constexpr NumberRange kHeight{0, 10, "m"};
constexpr NumberRange kSphereCount{1, 10'000, ""};
constexpr NumberRange kJointPosition{-1e6, 1e6, ""};

/// R = Rz(yaw) Ry(pitch) Rx(roll), degrees; then the translation.
Affine poseOf(const std::array<double, 3>& position, const std::array<double, 3>& rpy_degrees) {
  const auto rotation = [](double degrees) {
    const double angle = degrees * kRadiansPerDegree;
    return std::pair(std::cos(angle), std::sin(angle));
  };
  const auto [cr, sr] = rotation(rpy_degrees[0]);
  const auto [cp, sp] = rotation(rpy_degrees[1]);
  const auto [cy, sy] = rotation(rpy_degrees[2]);
  return {cy * cp,
          cy * sp * sr - sy * cr,
          cy * sp * cr + sy * sr,
          position[0],
          sy * cp,
          sy * sp * sr + cy * cr,
          sy * sp * cr - cy * sr,
          position[1],
          -sp,
          cp * sr,
          cp * cr,
          position[2]};
}

/// Reads the tables of one recipe.
class RecipeReader {
 public:
  RecipeReader(const TomlTable& table, FirstError& errors)
      : root_(table, "", 0, errors), errors_(errors) {}

  RobotRecipe read();

 private:
  std::optional<RecipeTable> open(RecipeTable& from, std::string_view key, const TomlTable* table) {
    if (table == nullptr) return std::nullopt;
    const TomlValue* value = from.find(key);
    return RecipeTable(*table, from.full(key), value == nullptr ? 0 : value->line, errors_);
  }
  void readEndEffector();
  void readCamera();
  void readLaser();
  Affine readMount(RecipeTable& table);
  void readBase();
  void readFootprint(RecipeTable& base);
  void readJoints();
  void readJoint(const TomlValue& entry, std::size_t index);
  void readLimits();
  void readStartPose();
  void readSpheres();
  void readLinkSpheres(const std::string& link, const TomlValue& entry);
  void readVerbatim(RecipeTable& table, RecipeLinkSpheres& link);
  void readIgnoredPairs();

  RecipeTable root_;
  FirstError& errors_;
  RobotRecipe recipe_;
};

void RecipeReader::readEndEffector() {
  auto table = open(root_, "end_effector", root_.requiredTable("end_effector"));
  if (!table) return;
  RecipeEndEffector& effector = recipe_.end_effector;
  effector.link = table->requiredName("link");
  effector.grasp_point = transformed(
      kYUpFromZUp, table->numbers<3>("grasp_point", kCoordinate).value_or(std::array<double, 3>{}));
  effector.grasp_radius = table->number("grasp_radius", kRadius).value_or(effector.grasp_radius);
  table->finish();
}

/// Where a sensor sits on its link.
Affine RecipeReader::readMount(RecipeTable& table) {
  const std::array<double, 3> zero{};
  const auto position = table.numbers<3>("position", kCoordinate).value_or(zero);
  const auto rpy = table.numbers<3>("rpy_degrees", {-360, 360, "degrees"}).value_or(zero);
  return conjugate(kYUpFromZUp, poseOf(position, rpy), kZUpFromYUp);
}

void RecipeReader::readCamera() {
  auto table = open(root_, "camera", root_.table("camera"));
  if (!table) return;
  RecipeCamera camera;
  camera.link = table->requiredName("link");
  camera.link_from_camera = readMount(*table);
  camera.vertical_fov =
      table->requiredNumber("vertical_fov_degrees", {1, 170, "degrees"}) * kRadiansPerDegree;
  table->finish();
  recipe_.camera = std::move(camera);
}

void RecipeReader::readLaser() {
  auto table = open(root_, "laser", root_.table("laser"));
  if (!table) return;
  RecipeLaser laser;
  laser.link = table->requiredName("link");
  laser.link_from_laser = readMount(*table);
  laser.field_of_view =
      table->requiredNumber("fov_degrees", {0, 360, "degrees"}) * kRadiansPerDegree;
  laser.range = table->requiredNumber("range", {0.1, 1000, "m"});
  laser.least_range = table->number("min_range", {0, 1000, "m"}).value_or(laser.least_range);
  laser.noise = table->number("noise", {0, 10, "m"}).value_or(laser.noise);
  if (laser.range > 0 && laser.least_range >= laser.range) {
    errors_.at(table->line(), "laser.min_range must be below laser.range");
  }
  table->finish();
  recipe_.laser = std::move(laser);
}

void RecipeReader::readFootprint(RecipeTable& base) {
  const auto radius = base.number("footprint_radius", kRadius);
  const auto rectangle = base.numbers<4>("footprint_rectangle", kCoordinate);
  if (radius && rectangle) {
    errors_.at(base.line(),
               "base has both footprint_radius and footprint_rectangle; keep one of them");
  } else if (radius) {
    recipe_.base.footprint = FootprintCircle{*radius};
  } else if (rectangle) {
    const auto& [min_x, min_y, max_x, max_y] = *rectangle;
    if (min_x >= max_x || min_y >= max_y) {
      errors_.at(base.line(),
                 "base.footprint_rectangle: expected [min x, min y, max x, max y] with each "
                 "min below its max");
    }
    recipe_.base.footprint =
        FootprintRectangle{.min_x = min_x, .max_x = max_x, .min_z = -max_y, .max_z = -min_y};
  } else {
    errors_.at(base.line(), "base has no footprint; give footprint_radius or footprint_rectangle");
  }
}

void RecipeReader::readBase() {
  auto table = open(root_, "base", root_.requiredTable("base"));
  if (!table) return;
  RecipeBase& base = recipe_.base;
  readFootprint(*table);
  base.forward_step = table->number("forward_step", {0.001, 1, "m"}).value_or(base.forward_step);
  if (const auto turn = table->number("turn_step_degrees", {0.1, 180, "degrees"})) {
    base.turn_step = *turn * kRadiansPerDegree;
  }
  base.root_height = table->number("root_height", {-2, 2, "m"}).value_or(base.root_height);
  table->finish();
}

void RecipeReader::readJoint(const TomlValue& entry, std::size_t index) {
  const std::string name = fmt::format("joints[{}]", index);
  const auto* content = std::get_if<TomlTable>(&entry.value);
  if (content == nullptr) {
    errors_.at(entry.line, fmt::format("{}: expected a table, [[joints]]", name));
    return;
  }
  RecipeTable table(*content, name, entry.line, errors_);
  RecipeJoint joint;
  joint.joint = table.requiredName("name");
  joint.step = table.requiredNumber("step", {1e-4, 3.2, "(radians or meters)"});
  joint.min = table.number("min", kJointPosition);
  joint.max = table.number("max", kJointPosition);
  if (joint.min && joint.max && *joint.min >= *joint.max) {
    errors_.at(entry.line, fmt::format("{}.min = {} is not below {}.max = {}", name, *joint.min,
                                       name, *joint.max));
  }
  table.finish();
  for (const RecipeJoint& other : recipe_.joints) {
    if (other.joint.name != joint.joint.name) continue;
    errors_.at(entry.line, fmt::format("joint '{}' is listed twice, see {}", joint.joint.name,
                                       other.joint.where));
  }
  recipe_.joints.push_back(std::move(joint));
}

void RecipeReader::readJoints() {
  const TomlArray* list = root_.list("joints");
  if (list == nullptr) return;
  for (std::size_t i = 0; i < list->size(); ++i) readJoint((*list)[i], i);
}

void RecipeReader::readLimits() {
  auto table = open(root_, "limits", root_.table("limits"));
  if (!table) return;
  for (const auto& [joint, value] : *root_.table("limits")) {
    const auto [lower, upper] = table->numbersOf<2>(value, table->full(joint), kJointPosition);
    if (lower > upper) {
      errors_.at(value.line, fmt::format("{} = [{}, {}]: the lower limit comes first",
                                         table->full(joint), lower, upper));
    }
    recipe_.limits.push_back({{joint, errors_.place(value.line)}, {lower, upper}});
  }
}

void RecipeReader::readStartPose() {
  auto table = open(root_, "start_pose", root_.table("start_pose"));
  if (!table) return;
  for (const auto& [joint, value] : *root_.table("start_pose")) {
    const auto position = table->numberOf(value, joint, kJointPosition);
    recipe_.start_pose.push_back({{joint, errors_.place(value.line)}, position.value_or(0)});
  }
}

void RecipeReader::readVerbatim(RecipeTable& table, RecipeLinkSpheres& link) {
  const TomlArray* spheres = table.list("spheres");
  if (spheres == nullptr) return;
  for (std::size_t i = 0; i < spheres->size(); ++i) {
    const std::string what = fmt::format("{}[{}]", table.full("spheres"), i);
    const auto numbers = table.numbersOf<4>((*spheres)[i], what, kCoordinate);
    if (numbers[3] < kRadius.min || numbers[3] > kRadius.max) {
      errors_.at((*spheres)[i].line, fmt::format("{} has the radius {}, expected {} to {} m", what,
                                                 numbers[3], kRadius.min, kRadius.max));
    }
    const auto center = transformed(kYUpFromZUp, std::array{numbers[0], numbers[1], numbers[2]});
    link.spheres.push_back({.center = center, .radius = numbers[3]});
  }
  if (spheres->empty()) {
    errors_.at(table.line(), fmt::format("{} is empty; a link without spheres says skip = true",
                                         table.full("spheres")));
  }
}

void RecipeReader::readLinkSpheres(const std::string& link, const TomlValue& entry) {
  const std::string name = fmt::format("spheres.links.{}", link);
  const auto* content = std::get_if<TomlTable>(&entry.value);
  if (content == nullptr) {
    errors_.at(entry.line, fmt::format("{}: expected a table, [{}]", name, name));
    return;
  }
  RecipeTable table(*content, name, entry.line, errors_);
  RecipeLinkSpheres spheres;
  spheres.link = {link, errors_.place(entry.line)};
  spheres.eps = table.number("eps", kTolerance);
  spheres.tau = table.number("tau", kTolerance);
  spheres.clip_height = table.number("clip_height", kHeight);
  spheres.max_spheres = table.count("max_spheres", kSphereCount);
  spheres.skip = table.flag("skip");
  spheres.merge_with_parent = table.flag("merge_with_parent");
  readVerbatim(table, spheres);
  table.finish();
  const bool fits = spheres.eps || spheres.tau || spheres.max_spheres || spheres.clip_height;
  const int ways = (spheres.skip ? 1 : 0) + (spheres.merge_with_parent ? 1 : 0) +
                   (spheres.spheres.empty() ? 0 : 1) + (fits ? 1 : 0);
  if (ways > 1) {
    errors_.at(entry.line, fmt::format("{} contradicts itself; keep one of: skip, "
                                       "merge_with_parent, spheres, or tolerances (eps, tau, "
                                       "max_spheres, clip_height)",
                                       name));
  }
  recipe_.spheres.links.push_back(std::move(spheres));
}

void RecipeReader::readSpheres() {
  auto table = open(root_, "spheres", root_.table("spheres"));
  if (!table) return;
  RecipeSpheres& spheres = recipe_.spheres;
  spheres.eps = table->number("eps", kTolerance).value_or(spheres.eps);
  spheres.tau = table->number("tau", kTolerance).value_or(spheres.tau);
  spheres.max_spheres = table->count("max_spheres", kSphereCount);
  const auto max_gap = table->number("max_gap", kTolerance);
  if (max_gap && spheres.max_spheres) {
    errors_.at(
        table->line(),
        "spheres has both max_spheres and max_gap; keep one of them: a number of spheres, or "
        "the widest gap");
  }
  spheres.max_gap = max_gap.value_or(spheres.max_gap);
  spheres.clip_height = table->number("clip_height", kHeight).value_or(spheres.clip_height);
  if (const TomlTable* links = table->table("links")) {
    for (const auto& [link, entry] : *links) readLinkSpheres(link, entry);
  }
  table->finish();
}

void RecipeReader::readIgnoredPairs() {
  auto table = open(root_, "self_collision", root_.table("self_collision"));
  if (!table) return;
  if (const TomlArray* pairs = table->list("ignore")) {
    for (const TomlValue& entry : *pairs) {
      const auto* pair = std::get_if<TomlArray>(&entry.value);
      const std::string what = "each entry of self_collision.ignore";
      if (pair == nullptr || pair->size() != 2) {
        errors_.at(entry.line, what + ": expected a pair of links, [\"a\", \"b\"]");
        continue;
      }
      recipe_.ignored_pairs.emplace_back(table->nameOf((*pair)[0], what),
                                         table->nameOf((*pair)[1], what));
    }
  }
  table->finish();
}

RobotRecipe RecipeReader::read() {
  recipe_.name = root_.requiredName("name").name;
  readEndEffector();
  readCamera();
  readLaser();
  readBase();
  readJoints();
  readLimits();
  readStartPose();
  readSpheres();
  readIgnoredPairs();
  root_.finish();
  return std::move(recipe_);
}

}  // namespace

Result<RobotRecipe> readRobotRecipe(const std::filesystem::path& path) {
  ASSIGN_OR_RETURN(const auto table, readToml(path));
  FirstError errors(path.string());
  RobotRecipe recipe = RecipeReader(table, errors).read();
  if (errors.error()) return tl::unexpected(*errors.error());
  recipe.source = path.string();
  return recipe;
}

}  // namespace galactic::bake
