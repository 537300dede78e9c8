#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "galactic/bake/robot_recipe.h"
#include "recipe/recipe_keys.h"

namespace galactic::bake {
namespace {

constexpr std::string_view kPreamble =
    "Robot recipe: what a robot's file does not say. Every key is shown; those with a default may "
    "be left "
    "out. Positions and rotations are in frames of that file (X forward, Y left, Z up); meters, "
    "radians unless a key says degrees.";

/// Writes a recipe that explains every key: an example or the default, and its meaning.
class RecipeExplainer {
 public:
  RecipeExplainer() { addComment(kPreamble); }

  void text(const RecipeKey& key, const std::string& /*field*/) {
    text_ += '\n';
    add(key, quoted(key.example), std::nullopt);
  }
  void name(const RecipeKey& key, const RecipeName& /*field*/) {
    add(key, quoted(key.example), std::nullopt);
  }
  void number(const RecipeKey& key, const double& field, const NumberRange& /*range*/) {
    add(key, std::string(key.example), fmt::format("{}", field));
  }
  void number(const RecipeKey& key, const std::optional<double>& /*field*/,
              const NumberRange& /*range*/) {
    add(key, std::string(key.example), std::nullopt);
  }
  void degrees(const RecipeKey& key, const double& field, const NumberRange& /*range*/) {
    add(key, std::string(key.example),
        fmt::format("{:.4g} ({} rad)", field * 180 / std::numbers::pi, field));
  }
  void count(const RecipeKey& key, const std::optional<std::uint32_t>& /*field*/,
             const NumberRange& /*range*/) {
    add(key, std::string(key.example), std::nullopt);
  }
  void flag(const RecipeKey& key, const bool& /*field*/) { add(key, "true", std::nullopt); }
  void point(const RecipeKey& key, const std::array<double, 3>& /*field*/) {
    add(key, std::string(key.example), "[0, 0, 0]");
  }
  void mount(const RecipeKey& position, const RecipeKey& rpy, const Affine& /*field*/) {
    add(position, std::string(position.example), "[0, 0, 0]");
    add(rpy, std::string(rpy.example), "[0, 0, 0]");
  }
  void footprint(const RecipeKey& circle, const RecipeKey& rectangle,
                 const std::variant<FootprintCircle, FootprintRectangle>& /*field*/) {
    add(circle, std::string(circle.example), std::nullopt);
    add(rectangle, std::string(rectangle.example), std::nullopt);
  }
  void spheres(const RecipeKey& key, const std::vector<HandSphere>& /*field*/) {
    add(key, std::string(key.example), std::nullopt);
  }

  template <class T>
  void table(const RecipeSection& section, const T& /*field*/) {
    explain<T>(section, section.name, "[{}]");
  }
  template <class T>
  void table(const RecipeSection& section, const std::optional<T>& /*field*/) {
    explain<T>(section, section.name, "[{}]");
  }
  void joints(const RecipeSection& section, const std::vector<RecipeJoint>& /*field*/) {
    explain<RecipeJoint>(section, section.name, "[[{}]]");
  }
  void links(const RecipeSection& section, const std::vector<RecipeLinkSpheres>& /*field*/) {
    explain<RecipeLinkSpheres>(
        section, fmt::format("{}.{}.{}", outer_, section.name, section.example), "[{}]");
  }
  void limits(const RecipeSection& section, const std::vector<RecipeLimits>& /*field*/) {
    addEntry(section, section.example);
  }
  void mimics(const RecipeSection& section, const std::vector<RecipeMimic>& /*field*/) {
    explain<RecipeMimic>(section, fmt::format("{}.{}", section.name, section.example), "[{}]");
  }
  void positions(const RecipeSection& section, const std::vector<RecipeStart>& /*field*/) {
    addEntry(section, section.example);
  }
  void pairs(const RecipeSection& section, std::string_view key,
             const std::vector<std::pair<RecipeName, RecipeName>>& /*field*/) {
    addEntry(section, fmt::format("{} = {}", key, section.example));
  }

  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  static constexpr std::size_t kWidth = 100;
  static constexpr std::size_t kHelpColumn = 34;

  static std::string quoted(std::string_view name) { return fmt::format("\"{}\"", name); }

  /// Adds a comment in lines of at most kWidth, broken between words.
  void addComment(std::string_view help) {
    std::string line = "#";
    while (!help.empty()) {
      const std::size_t end = std::min(help.find(' '), help.size());
      if (line.size() + 1 + end > kWidth) {
        text_ += line + '\n';
        line.resize(1);
      }
      line += fmt::format(" {}", help.substr(0, end));
      help.remove_prefix(std::min(end + 1, help.size()));
    }
    text_ += line + '\n';
  }

  /// `normal` is the default; none if the key is required, or if the help says what happens without
  /// it.
  void add(const RecipeKey& key, std::string value, const std::optional<std::string>& normal) {
    const bool shows_default = normal && !key.is_required;
    if (value.empty()) value = normal.value_or("");
    std::string line =
        fmt::format("{}{} = {}", key.is_alternative ? "# " : "", key.name, std::move(value));
    std::string help(key.help);
    if (shows_default) help += fmt::format("{}default {}", help.empty() ? "" : "; ", *normal);
    if (!help.empty()) line = fmt::format("{:<{}}# {}", line + "  ", kHelpColumn, help);
    text_ += line + '\n';
  }

  void addEntry(const RecipeSection& section, std::string_view entry) {
    text_ += '\n';
    addComment(section.help);
    text_ += fmt::format("[{}]\n{}\n", section.name, entry);
  }

  /// Adds a table with the keys of a T; `form` is the format of its heading.
  template <class T>
  void explain(const RecipeSection& section, std::string_view name, fmt::string_view form) {
    text_ += '\n';
    addComment(section.help);
    text_ += fmt::vformat(form, fmt::make_format_args(name)) + '\n';
    outer_ = name;
    T defaults{};
    visitKeys(defaults, *this);
  }

  std::string text_;
  /// Name of the table whose keys are being explained.
  std::string outer_;
};

}  // namespace

std::string describeRobotRecipe() {
  RobotRecipe defaults;
  RecipeExplainer explainer;
  visitKeys(defaults, explainer);
  return explainer.take();
}

}  // namespace galactic::bake
