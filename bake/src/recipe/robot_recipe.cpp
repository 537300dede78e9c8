#include "galactic/bake/robot_recipe.h"

#include <cmath>
#include <numbers>
#include <string_view>

#include "import/affine.h"
#include "recipe/recipe_keys.h"
#include "robot_description/frames.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

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

void check(const RecipeLaser& laser, RecipeTable& table) {
  if (laser.range > 0 && laser.least_range >= laser.range) {
    table.errors().at(table.line(), "laser.min_range must be below laser.range");
  }
}

void check(const RecipeJoint& joint, RecipeTable& table) {
  if (!joint.min || !joint.max || *joint.min < *joint.max) return;
  table.errors().at(table.line(), fmt::format("{} = {} is not below {} = {}", table.full("min"),
                                              *joint.min, table.full("max"), *joint.max));
}

void check(const RecipeLinkSpheres& link, RecipeTable& table) {
  const bool fits = link.eps || link.tau || link.max_spheres || link.clip_height;
  const int ways = (link.skip ? 1 : 0) + (link.merge_with_parent ? 1 : 0) +
                   (link.spheres.empty() ? 0 : 1) + (fits ? 1 : 0);
  if (ways <= 1) return;
  table.errors().at(table.line(), table.name() +
                                      " contradicts itself; keep one of: skip, merge_with_parent, "
                                      "spheres, or tolerances (eps, tau, max_spheres, "
                                      "clip_height)");
}

void check(const RecipeSpheres& spheres, RecipeTable& table) {
  if (!spheres.max_spheres || table.find("max_gap") == nullptr) return;
  table.errors().at(table.line(),
                    "spheres has both max_spheres and max_gap; keep one of them: a number of "
                    "spheres, or the widest gap");
}

template <class T>
void check(const T& /*table has no two keys that go together*/, RecipeTable& /*table*/) {}

/// Reads the keys of one table, and of its subtables, into the corresponding fields.
class RecipeReader {
 public:
  explicit RecipeReader(RecipeTable& table) : table_(table), errors_(table.errors()) {}

  /// Reads all keys of a table.
  template <class T>
  static void read(RecipeTable& table, T& fields) {
    RecipeReader reader(table);
    visitKeys(fields, reader);
    check(fields, table);
    table.finish();
  }

  void text(const RecipeKey& key, std::string& field) {
    field = table_.requiredName(key.name).name;
  }
  void name(const RecipeKey& key, RecipeName& field) { field = table_.requiredName(key.name); }
  void number(const RecipeKey& key, double& field, const NumberRange& range) {
    field = key.is_required ? table_.requiredNumber(key.name, range)
                            : table_.number(key.name, range).value_or(field);
  }
  void number(const RecipeKey& key, std::optional<double>& field, const NumberRange& range) {
    field = table_.number(key.name, range);
  }
  /// Degrees in the recipe become radians in the field.
  void degrees(const RecipeKey& key, double& field, const NumberRange& range) {
    double typed = field / kRadiansPerDegree;
    number(key, typed, range);
    if (table_.find(key.name) != nullptr) field = typed * kRadiansPerDegree;
  }
  void count(const RecipeKey& key, std::optional<std::uint32_t>& field, const NumberRange& range) {
    field = table_.count(key.name, range);
  }
  void flag(const RecipeKey& key, bool& field) { field = table_.flag(key.name); }
  void point(const RecipeKey& key, std::array<double, 3>& field) {
    field = transformed(kYUpFromZUp, vector(key, kCoordinate));
  }
  void mount(const RecipeKey& position, const RecipeKey& rpy, Affine& field) {
    const auto at = vector(position, kCoordinate);
    const auto turned = vector(rpy, {-360, 360, "degrees"});
    field = conjugate(kYUpFromZUp, poseOf(at, turned), kZUpFromYUp);
  }
  void footprint(const RecipeKey& circle, const RecipeKey& rectangle,
                 std::variant<FootprintCircle, FootprintRectangle>& field);
  void spheres(const RecipeKey& key, std::vector<HandSphere>& field);

  template <class T>
  void table(const RecipeSection& section, T& field) {
    const TomlTable* inner =
        section.is_required ? table_.requiredTable(section.name) : table_.table(section.name);
    if (inner == nullptr) return;
    RecipeTable one = open(section.name, *inner);
    read(one, field);
  }
  template <class T>
  void table(const RecipeSection& section, std::optional<T>& field) {
    if (table_.table(section.name) == nullptr) return;
    table(section, field.emplace());
  }
  void joints(const RecipeSection& section, std::vector<RecipeJoint>& field);
  void links(const RecipeSection& section, std::vector<RecipeLinkSpheres>& field);
  void limits(const RecipeSection& section, std::vector<RecipeLimits>& field);
  void mimics(const RecipeSection& section, std::vector<RecipeMimic>& field);
  void positions(const RecipeSection& section, std::vector<RecipeStart>& field);
  void pairs(const RecipeSection& section, std::string_view key,
             std::vector<std::pair<RecipeName, RecipeName>>& field);

 private:
  std::array<double, 3> vector(const RecipeKey& key, const NumberRange& range) {
    return table_.numbers<3>(key.name, range).value_or(std::array<double, 3>{});
  }
  RecipeTable open(std::string_view name, const TomlTable& inner) {
    const TomlValue* value = table_.find(name);
    return {inner, table_.full(name), value == nullptr ? 0 : value->line, errors_};
  }
  /// Reads a table that is in a list or in a table of tables; reports anything else.
  template <class T>
  void readOne(const TomlValue& entry, const std::string& name, std::string_view form, T& fields) {
    const auto* content = std::get_if<TomlTable>(&entry.value);
    if (content == nullptr) {
      return errors_.at(entry.line, fmt::format("{}: expected a table, {}", name, form));
    }
    RecipeTable one(*content, name, entry.line, errors_);
    read(one, fields);
  }

  RecipeTable& table_;
  FirstError& errors_;
};

void RecipeReader::footprint(const RecipeKey& circle, const RecipeKey& rectangle,
                             std::variant<FootprintCircle, FootprintRectangle>& field) {
  const auto radius = table_.number(circle.name, kSphereRadius);
  const auto sides = table_.numbers<4>(rectangle.name, kCoordinate);
  if (radius && sides) {
    errors_.at(table_.line(), fmt::format("{} has both {} and {}; keep one of them", table_.name(),
                                          circle.name, rectangle.name));
  } else if (radius) {
    field = FootprintCircle{*radius};
  } else if (sides) {
    const auto& [min_x, min_y, max_x, max_y] = *sides;
    if (min_x >= max_x || min_y >= max_y) {
      errors_.at(table_.line(), fmt::format("{}: expected [min x, min y, max x, max y] with each "
                                            "min below its max",
                                            table_.full(rectangle.name)));
    }
    field = FootprintRectangle{.min_x = min_x, .max_x = max_x, .min_z = -max_y, .max_z = -min_y};
  } else {
    errors_.at(table_.line(), fmt::format("{} has no footprint; give {} or {}", table_.name(),
                                          circle.name, rectangle.name));
  }
}

void RecipeReader::spheres(const RecipeKey& key, std::vector<HandSphere>& field) {
  const TomlArray* list = table_.list(key.name);
  if (list == nullptr) return;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string what = fmt::format("{}[{}]", table_.full(key.name), i);
    const auto numbers = table_.numbersOf<4>((*list)[i], what, kCoordinate);
    if (numbers[3] < kSphereRadius.min || numbers[3] > kSphereRadius.max) {
      errors_.at((*list)[i].line, fmt::format("{} has the radius {}, expected {} to {} m", what,
                                              numbers[3], kSphereRadius.min, kSphereRadius.max));
    }
    const auto center = transformed(kYUpFromZUp, std::array{numbers[0], numbers[1], numbers[2]});
    field.push_back({.center = center, .radius = numbers[3]});
  }
  if (list->empty()) {
    errors_.at(table_.line(), fmt::format("{} is empty; a link without spheres says skip = true",
                                          table_.full(key.name)));
  }
}

void RecipeReader::joints(const RecipeSection& section, std::vector<RecipeJoint>& field) {
  const TomlArray* list = table_.list(section.name);
  if (list == nullptr) return;
  for (std::size_t i = 0; i < list->size(); ++i) {
    RecipeJoint joint;
    readOne((*list)[i], fmt::format("{}[{}]", section.name, i), fmt::format("[[{}]]", section.name),
            joint);
    for (const RecipeJoint& other : field) {
      if (other.joint.name != joint.joint.name) continue;
      errors_.at((*list)[i].line, fmt::format("joint '{}' is listed twice, see {}",
                                              joint.joint.name, other.joint.where));
    }
    field.push_back(std::move(joint));
  }
}

void RecipeReader::links(const RecipeSection& section, std::vector<RecipeLinkSpheres>& field) {
  const TomlTable* links = table_.table(section.name);
  if (links == nullptr) return;
  for (const auto& [link, entry] : *links) {
    const std::string name = fmt::format("{}.{}", table_.full(section.name), link);
    RecipeLinkSpheres spheres;
    spheres.link = {link, errors_.place(entry.line)};
    readOne(entry, name, fmt::format("[{}]", name), spheres);
    field.push_back(std::move(spheres));
  }
}

void RecipeReader::limits(const RecipeSection& section, std::vector<RecipeLimits>& field) {
  const TomlTable* limits = table_.table(section.name);
  if (limits == nullptr) return;
  RecipeTable table = open(section.name, *limits);
  for (const auto& [joint, value] : *limits) {
    const auto [lower, upper] = table.numbersOf<2>(value, table.full(joint), kJointPosition);
    if (lower > upper) {
      errors_.at(value.line, fmt::format("{} = [{}, {}]: the lower limit comes first",
                                         table.full(joint), lower, upper));
    }
    field.push_back({{joint, errors_.place(value.line)}, {lower, upper}});
  }
}

void RecipeReader::mimics(const RecipeSection& section, std::vector<RecipeMimic>& field) {
  const TomlTable* mimics = table_.table(section.name);
  if (mimics == nullptr) return;
  for (const auto& [joint, entry] : *mimics) {
    const std::string name = fmt::format("{}.{}", table_.full(section.name), joint);
    RecipeMimic mimic;
    mimic.joint = {joint, errors_.place(entry.line)};
    readOne(entry, name, fmt::format("[{}]", name), mimic);
    field.push_back(std::move(mimic));
  }
}

void RecipeReader::positions(const RecipeSection& section, std::vector<RecipeStart>& field) {
  const TomlTable* positions = table_.table(section.name);
  if (positions == nullptr) return;
  RecipeTable table = open(section.name, *positions);
  for (const auto& [joint, value] : *positions) {
    const auto position = table.numberOf(value, joint, kJointPosition);
    field.push_back({{joint, errors_.place(value.line)}, position.value_or(0)});
  }
}

void RecipeReader::pairs(const RecipeSection& section, std::string_view key,
                         std::vector<std::pair<RecipeName, RecipeName>>& field) {
  const TomlTable* inner = table_.table(section.name);
  if (inner == nullptr) return;
  RecipeTable table = open(section.name, *inner);
  const TomlArray* pairs = table.list(key);
  const std::size_t count = pairs == nullptr ? 0 : pairs->size();
  for (std::size_t i = 0; i < count; ++i) {
    const TomlValue& entry = (*pairs)[i];
    const auto* pair = std::get_if<TomlArray>(&entry.value);
    const std::string what = fmt::format("each entry of {}", table.full(key));
    if (pair == nullptr || pair->size() != 2) {
      errors_.at(entry.line, what + ": expected a pair of links, [\"a\", \"b\"]");
      continue;
    }
    field.emplace_back(table.nameOf((*pair)[0], what), table.nameOf((*pair)[1], what));
  }
  table.finish();
}

}  // namespace

Result<RobotRecipe> readRobotRecipe(const std::filesystem::path& path) {
  ASSIGN_OR_RETURN(const auto table, readToml(path));
  FirstError errors(path.string());
  RobotRecipe recipe;
  RecipeTable root(table, "", 0, errors);
  RecipeReader::read(root, recipe);
  if (errors.error()) return tl::unexpected(*errors.error());
  recipe.source = path.string();
  return recipe;
}

}  // namespace galactic::bake
