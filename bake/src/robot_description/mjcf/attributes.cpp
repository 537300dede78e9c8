#include "robot_description/mjcf/attributes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include "import/affine.h"
#include "support/text/nearest_name.h"

namespace galactic::bake {
namespace {

/// Shorter vectors have no direction.
constexpr double kShortest = 1e-12;

constexpr std::array<std::string_view, 5> kOrientations{"quat", "axisangle", "euler", "xyaxes",
                                                        "zaxis"};

using Vector = std::array<double, 3>;

double lengthOf(std::span<const double> vector) {
  double square = 0;
  for (const double v : vector) square += v * v;
  return std::sqrt(square);
}

double dotOf(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector crossOf(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The numbers of a list separated by blanks; none if it contains anything else.
std::optional<std::vector<double>> numbersIn(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    if (text.empty()) return numbers;
    if (text.front() == '+') text.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    const bool ends =
        text.empty() || std::string_view(" \t\r\n").find(text.front()) != std::string_view::npos;
    if (error != std::errc{} || !ends || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
  }
}

std::string countText(std::size_t least, std::size_t most) {
  constexpr std::array<std::string_view, 7> kWords{"no",   "one",  "two", "three",
                                                   "four", "five", "six"};
  const auto word = [&](std::size_t n) {
    return n < kWords.size() ? std::string(kWords[n]) : fmt::format("{}", n);
  };
  if (least == 1 && most == 1) return "a finite number";
  return least == most ? fmt::format("{} finite numbers", word(least))
                       : fmt::format("{} to {} finite numbers", word(least), word(most));
}

Affine rotationOfColumns(const Vector& x, const Vector& y, const Vector& z) {
  return {x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0};
}

Affine rotationOfAxes(const MjcfAttributes& attributes, const std::array<double, 6>& axes) {
  Vector x{axes[0], axes[1], axes[2]};
  Vector y{axes[3], axes[4], axes[5]};
  const double x_length = lengthOf(x);
  for (double& v : x) v /= x_length;
  const double along = dotOf(x, y);
  for (std::size_t n = 0; n < 3; ++n) y[n] -= along * x[n];
  const double y_length = lengthOf(y);
  for (double& v : y) v /= y_length;
  if (!(x_length > kShortest && y_length > kShortest)) {
    attributes.error("xyaxes", "two directions that differ, each of three numbers");
    return kIdentityAffine;
  }
  return rotationOfColumns(x, y, crossOf(x, y));
}

/// Lower-case letters are rotations about the axes rotated so far, upper-case ones about those of
/// the parent.
Affine rotationOfAngles(const Vector& angles, const MjcfSettings& settings) {
  Affine turned = kIdentityAffine;
  for (std::size_t n = 0; n < 3; ++n) {
    const char letter = settings.euler_sequence[n];
    const bool is_fixed = letter >= 'X' && letter <= 'Z';
    Vector axis{};
    axis[static_cast<std::size_t>(letter - (is_fixed ? 'X' : 'x'))] = 1;
    const Affine turn = rotationAbout(axis, settings.radians(angles[n]));
    turned = is_fixed ? compose(turn, turned) : compose(turned, turn);
  }
  return turned;
}

Affine orientationOf(const MjcfAttributes& attributes, const MjcfSettings& settings) {
  const auto stated = std::ranges::count_if(
      kOrientations, [&](std::string_view name) { return attributes.has(name); });
  if (stated > 1) {
    attributes.findings().error(
        attributes.element().place,
        fmt::format("<{}> has several orientations; keep one of {}", attributes.element().name,
                    fmt::join(kOrientations, ", ")));
  }
  const auto is_short = [&](std::string_view name, std::span<const double> vector) {
    if (lengthOf(vector) > kShortest) return false;
    attributes.error(name, "a direction, not zeros");
    return true;
  };
  if (const auto quat = attributes.vector<4>("quat")) {
    if (!is_short("quat", *quat)) return rotationOf(*quat);
  }
  if (const auto turn = attributes.vector<4>("axisangle")) {
    const Vector axis{(*turn)[0], (*turn)[1], (*turn)[2]};
    if (!is_short("axisangle", axis)) return rotationAbout(axis, settings.radians((*turn)[3]));
  }
  if (const auto angles = attributes.vector<3>("euler")) return rotationOfAngles(*angles, settings);
  if (const auto axes = attributes.vector<6>("xyaxes")) return rotationOfAxes(attributes, *axes);
  if (const auto z = attributes.vector<3>("zaxis")) {
    if (!is_short("zaxis", *z)) return rotationOfZ(*z);
  }
  return kIdentityAffine;
}

}  // namespace

const std::string* MjcfAttributes::find(std::string_view name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? nullptr : &found->second;
}

std::string MjcfAttributes::text(std::string_view name) const {
  const std::string* value = find(name);
  return value == nullptr ? std::string() : *value;
}

void MjcfAttributes::error(std::string_view name, std::string_view expected) const {
  findings_.error(element_.place, fmt::format("<{}> has {}=\"{}\", expected {}", element_.name,
                                              name, text(name), expected));
}

std::optional<std::vector<double>> MjcfAttributes::numbers(std::string_view name, std::size_t least,
                                                           std::size_t most) const {
  const std::string* value = find(name);
  if (value == nullptr) return std::nullopt;
  auto list = numbersIn(*value);
  if (list && list->size() >= least && list->size() <= most) return list;
  error(name, countText(least, most));
  return std::nullopt;
}

double MjcfAttributes::number(std::string_view name, double fallback) const {
  const auto one = vector<1>(name);
  return one ? one->front() : fallback;
}

std::size_t MjcfAttributes::choice(std::string_view name, std::span<const std::string_view> words,
                                   std::size_t fallback) const {
  const std::string* value = find(name);
  if (value == nullptr) return fallback;
  const auto found = std::ranges::find(words, *value);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  error(name, fmt::format("one of {}", fmt::join(words, ", ")));
  return fallback;
}

bool MjcfAttributes::flag(std::string_view name, bool fallback) const {
  constexpr std::array<std::string_view, 2> kWords{"false", "true"};
  return choice(name, kWords, fallback ? 1 : 0) == 1;
}

void MjcfDefaults::add(const XmlElement& outermost) {
  if (const std::string* name = outermost.find("class")) names_of_all_.insert(*name);
  fill(outermost, "");
}

void MjcfDefaults::fill(const XmlElement& source, const std::string& name) {
  for (const XmlElement& child : source.children) {
    if (child.name == "default") continue;
    AttributeMap& attributes = classes_[name][child.name];
    for (const auto& [key, value] : child.attributes) attributes[key] = value;
  }
  for (const XmlElement& child : source.children) {
    if (child.name != "default") continue;
    const std::string* own = child.find("class");
    if (own == nullptr || own->empty()) {
      findings_.error(child.place, "<default> in another has no attribute 'class'; name it");
      continue;
    }
    ElementDefaults inherited = classes_[name];
    classes_[*own] = std::move(inherited);
    fill(child, *own);
  }
}

MjcfAttributes MjcfDefaults::attributesOf(const XmlElement& element,
                                          const std::string& inherited) const {
  const std::string* stated = element.find("class");
  const std::string& name = stated == nullptr ? inherited : *stated;
  const auto found = classes_.find(name);
  if (found == classes_.end() && !names_of_all_.contains(name)) {
    std::vector<std::string> names;
    for (const auto& [known, unused] : classes_) {
      if (!known.empty()) names.push_back(known);
    }
    findings_.error(element.place, fmt::format("<{}> is of class '{}', which no <default> has; {}",
                                               element.name, name, suggestNames(name, names)));
  }
  AttributeMap values;
  const ElementDefaults& defaults =
      found == classes_.end() ? classes_.find("")->second : found->second;
  if (const auto given = defaults.find(element.name); given != defaults.end()) {
    values = given->second;
  }
  // Any orientation replaces any other, even one in another form.
  const auto is_orientation = [](const auto& attribute) {
    return std::ranges::find(kOrientations, attribute.first) != kOrientations.end();
  };
  if (std::ranges::any_of(element.attributes, is_orientation)) {
    std::erase_if(values, is_orientation);
  }
  for (const auto& [key, value] : element.attributes) values[key] = value;
  return {element, std::move(values), findings_};
}

double MjcfSettings::radians(double angle) const {
  return in_degrees ? angle * (std::numbers::pi / 180) : angle;
}

void MjcfSettings::read(const MjcfAttributes& compiler) {
  constexpr std::array<std::string_view, 2> kAngles{"radian", "degree"};
  constexpr std::array<std::string_view, 2> kCoordinates{"local", "global"};
  constexpr std::array<std::string_view, 3> kInertias{"true", "false", "auto"};
  in_degrees = compiler.choice("angle", kAngles, in_degrees ? 1 : 0) == 1;
  auto_limits = compiler.flag("autolimits", auto_limits);
  strips_paths = compiler.flag("strippath", strips_paths);
  inertias = static_cast<Inertias>(
      compiler.choice("inertiafromgeom", kInertias, static_cast<std::size_t>(inertias)));
  massive_groups = compiler.vector<2>("inertiagrouprange").value_or(massive_groups);
  if (const double mass = compiler.number("settotalmass", -1); mass > 0) total_mass = mass;
  if (compiler.choice("coordinate", kCoordinates, 0) == 1) {
    compiler.findings().error(
        compiler.element().place,
        "<compiler> has coordinate=\"global\", which MuJoCo has given up, too; load the file in an "
        "older MuJoCo, save it, and give what it saved",
        ErrorCode::kUnsupported);
  }
  if (const std::string* sequence = compiler.find("eulerseq")) {
    if (sequence->size() == 3 && sequence->find_first_not_of("xyzXYZ") == std::string::npos) {
      euler_sequence = *sequence;
    } else {
      compiler.error("eulerseq", "three letters of x, y, z, X, Y, Z");
    }
  }
  if (const std::string* folder = compiler.find("assetdir")) {
    mesh_folder = *folder;
    texture_folder = *folder;
  }
  if (const std::string* folder = compiler.find("meshdir")) mesh_folder = *folder;
  if (const std::string* folder = compiler.find("texturedir")) texture_folder = *folder;
}

Affine rotationOf(const std::array<double, 4>& quaternion) {
  const double length = lengthOf(quaternion);
  const double w = quaternion[0] / length;
  const double x = quaternion[1] / length;
  const double y = quaternion[2] / length;
  const double z = quaternion[3] / length;
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),     0,
          2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),     0,
          2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y), 0};
}

Affine rotationAbout(const Vector& axis, double angle) {
  const double scale = std::sin(angle / 2) / lengthOf(axis);
  return rotationOf({std::cos(angle / 2), scale * axis[0], scale * axis[1], scale * axis[2]});
}

Affine rotationOfZ(const Vector& direction) {
  const double length = lengthOf(direction);
  const Vector to{direction[0] / length, direction[1] / length, direction[2] / length};
  const Vector axis = crossOf({0, 0, 1}, to);
  const double sine = lengthOf(axis);
  // As in MuJoCo, turning Z upside down is a rotation about X.
  if (sine < kShortest) return rotationAbout({1, 0, 0}, to[2] < 0 ? std::numbers::pi : 0);
  return rotationAbout(axis, std::atan2(sine, to[2]));
}

Affine translationOf(const Vector& offset) {
  return {1, 0, 0, offset[0], 0, 1, 0, offset[1], 0, 0, 1, offset[2]};
}

Affine poseOf(const MjcfAttributes& attributes, const MjcfSettings& settings) {
  const Vector position = attributes.vector<3>("pos").value_or(Vector{});
  return compose(translationOf(position), orientationOf(attributes, settings));
}

}  // namespace galactic::bake
