#include "robot_description/urdf/urdf_reader_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

namespace galactic::bake {
namespace {

constexpr const char* kBlanks = " \t\r\n";

/// Lists of numbers, which the parser splits only at blanks, and single numbers, around which it
/// accepts no blanks.
constexpr std::array<std::string_view, 5> kNumberLists{"xyz", "rpy", "scale", "size", "rgba"};
constexpr std::array<std::string_view, 13> kNumbers{
    "radius", "length", "lower", "upper", "offset", "multiplier", "value",
    "ixx",    "ixy",    "ixz",   "iyy",   "iyz",    "izz"};

/// Elements that nothing here reads, and that the parser refuses if something in them is missing.
constexpr std::array<const char*, 3> kUnreadOfJoints{"dynamics", "safety_controller",
                                                     "calibration"};

std::string_view textOf(const TiXmlElement& element, const char* attribute) {
  const char* value = element.Attribute(attribute);
  return value == nullptr ? std::string_view() : std::string_view(value);
}

/// Returns a list, so that they can be removed one by one.
std::vector<TiXmlElement*> childrenOf(TiXmlElement& parent, const char* tag) {
  std::vector<TiXmlElement*> children;
  for (auto* child = parent.FirstChildElement(tag); child != nullptr;
       child = child->NextSiblingElement(tag)) {
    children.push_back(child);
  }
  return children;
}

/// Warnings that often occur many times in a file: keeps the first of each kind, and their number.
class Remarks {
 public:
  void add(const std::string& kind, std::string sentence) {
    const auto known = std::ranges::find(kinds_, kind, &Kind::name);
    if (known != kinds_.end()) {
      ++known->count;
    } else {
      kinds_.push_back({kind, std::move(sentence), 1});
    }
  }

  void appendTo(std::vector<std::string>& warnings) const {
    for (const Kind& kind : kinds_) {
      warnings.push_back(kind.count == 1
                             ? kind.sentence
                             : fmt::format("{} ({} times in the file)", kind.sentence, kind.count));
    }
  }

 private:
  struct Kind {
    std::string name;
    std::string sentence;
    std::size_t count = 0;
  };
  std::vector<Kind> kinds_;
};

/// Replaces other separators between numbers in real files with blanks: commas (with a remark),
/// tabs and line ends.
void separateByBlanks(TiXmlAttribute& list, int line, Remarks& remarks) {
  std::string value = list.Value();
  if (value.find_first_of(",\t\r\n") == std::string::npos) return;
  if (value.find(',') != std::string::npos) {
    remarks.add(list.Name(), fmt::format("line {}: {}=\"{}\" has commas, which count as blanks",
                                         line, list.Name(), value));
  }
  std::ranges::replace_if(
      value, [](char c) { return c == ',' || c == '\t' || c == '\r' || c == '\n'; }, ' ');
  list.SetValue(value);
}

/// Removes the blanks around a number.
void trim(TiXmlAttribute& number) {
  std::string value = number.Value();
  value.erase(value.find_last_not_of(kBlanks) + 1);
  value.erase(0, std::min(value.find_first_not_of(kBlanks), value.size()));
  number.SetValue(value);
}

void tidyNumbers(TiXmlElement& robot, Remarks& remarks) {
  for (TiXmlElement* at = &robot; at != nullptr; at = nextElement(*at)) {
    for (auto* a = at->FirstAttribute(); a != nullptr; a = a->Next()) {
      if (std::ranges::find(kNumberLists, a->Name()) != kNumberLists.end()) {
        separateByBlanks(*a, at->Row(), remarks);
      } else if (std::ranges::find(kNumbers, a->Name()) != kNumbers.end()) {
        trim(*a);
      }
    }
  }
}

/// Gives the joints of `robot` the limits that the parser requires.
void completeLimits(TiXmlElement& robot, std::set<std::string>& without_limits) {
  for (TiXmlElement* joint : childrenOf(robot, "joint")) {
    const std::string_view type = textOf(*joint, "type");
    const bool needs_limits = type == "revolute" || type == "prismatic";
    TiXmlElement* limit = joint->FirstChildElement("limit");
    if (limit == nullptr && !needs_limits) continue;
    if (limit == nullptr) limit = joint->LinkEndChild(new TiXmlElement("limit"))->ToElement();
    if (needs_limits && limit->Attribute("lower") == nullptr &&
        limit->Attribute("upper") == nullptr) {
      without_limits.emplace(textOf(*joint, "name"));
    }
    for (const char* unread : {"effort", "velocity"}) limit->SetAttribute(unread, "0");
  }
}

void removeUnread(TiXmlElement& robot, DescriptionPart part) {
  for (TiXmlElement* joint : childrenOf(robot, "joint")) {
    for (const char* tag : kUnreadOfJoints) {
      for (TiXmlElement* unread : childrenOf(*joint, tag)) joint->RemoveChild(unread);
    }
  }
  if (part == DescriptionPart::kMasses) return;
  for (TiXmlElement* link : childrenOf(robot, "link")) {
    for (TiXmlElement* unread : childrenOf(*link, "inertial")) link->RemoveChild(unread);
  }
}

/// Brings numbers into the range from 0 to 1: if all are whole and one exceeds 1, they count as
/// bytes; otherwise they are clamped.
void toUnitScale(std::span<double> numbers) {
  constexpr double kMostOfByte = 255;
  const bool are_whole = std::ranges::all_of(numbers, [](double n) { return n == std::floor(n); });
  const bool are_bytes = are_whole && std::ranges::max(numbers) > 1;
  for (double& n : numbers) n = std::clamp(are_bytes ? n / kMostOfByte : n, 0.0, 1.0);
}

/// Brings the color of a material into the range that the parser accepts, or removes it.
void repairColor(TiXmlElement& material, Remarks& remarks) {
  TiXmlElement* color = material.FirstChildElement("color");
  if (color == nullptr || color->Attribute("rgba") == nullptr) return;
  const std::string stated = color->Attribute("rgba");
  const auto numbers = numbersOf(stated.c_str(), 4);
  const auto is_finite = [](double value) { return std::isfinite(value); };
  if (!numbers || !std::ranges::all_of(*numbers, is_finite)) {
    color->RemoveAttribute("rgba");
    remarks.add("color", fmt::format("line {}: rgba=\"{}\" is not four numbers from 0 to 1; the "
                                     "material has no color",
                                     color->Row(), stated));
    return;
  }
  std::vector<double> rgba = *numbers;
  // Some files have colors in bytes with an alpha of 1.
  toUnitScale(std::span(rgba).first(3));
  toUnitScale(std::span(rgba).last(1));
  if (rgba == *numbers) return;
  color->SetAttribute("rgba", fmt::format("{}", fmt::join(rgba, " ")));
  remarks.add("scale", fmt::format("line {}: rgba=\"{}\" is not within 0 to 1; it counts as {:.3}",
                                   color->Row(), stated, fmt::join(rgba, " ")));
}

bool hasColorOrTexture(TiXmlElement& material) {
  const TiXmlElement* color = material.FirstChildElement("color");
  const TiXmlElement* texture = material.FirstChildElement("texture");
  return (color != nullptr && color->Attribute("rgba") != nullptr) ||
         (texture != nullptr && texture->Attribute("filename") != nullptr);
}

/// Repairs or removes materials that the parser refuses.
void tidyMaterials(TiXmlElement& robot, Remarks& remarks) {
  for (TiXmlElement* material : childrenOf(robot, "material")) {
    repairColor(*material, remarks);
    if (material->Attribute("name") != nullptr && hasColorOrTexture(*material)) continue;
    // The parser warns if anything refers to it.
    robot.RemoveChild(material);
  }
  for (TiXmlElement* link : childrenOf(robot, "link")) {
    for (TiXmlElement* visual : childrenOf(*link, "visual")) {
      TiXmlElement* material = visual->FirstChildElement("material");
      if (material == nullptr) continue;
      repairColor(*material, remarks);
      // The parser does not share materials with an empty name.
      if (material->Attribute("name") == nullptr) material->SetAttribute("name", "");
    }
  }
}

/// Declares the link "world" if joints are attached to it and no link has this name.
void declareWorld(TiXmlElement& robot, std::vector<std::string>& warnings) {
  constexpr const char* kWorld = "world";
  for (const TiXmlElement* link : childrenOf(robot, "link")) {
    if (textOf(*link, "name") == kWorld) return;
  }
  for (const TiXmlElement* joint : childrenOf(robot, "joint")) {
    const TiXmlElement* parent = joint->FirstChildElement("parent");
    if (parent == nullptr || textOf(*parent, "link") != kWorld) continue;
    warnings.push_back(
        fmt::format("joint '{}': it hangs from a link '{}', which the file does not declare; it "
                    "counts as an empty link",
                    textOf(*joint, "name"), kWorld));
    TiXmlElement world("link");
    world.SetAttribute("name", kWorld);
    robot.InsertBeforeChild(robot.FirstChild(), world);
    return;
  }
}

/// The parts that replace the <visual> or <collision> of a capsule: copies of it with a cylinder
/// and a sphere at each end. None if the text makes no sense; the parser then reports it.
std::vector<TiXmlElement> partsOfCapsule(const TiXmlElement& element, const TiXmlElement& capsule) {
  const auto radius = numbersOf(capsule.Attribute("radius"), 1);
  const auto length = numbersOf(capsule.Attribute("length"), 1);
  const TiXmlElement* origin = element.FirstChildElement("origin");
  const auto numbers_of_origin = [&](const char* attribute) {
    const bool stated = origin != nullptr && origin->Attribute(attribute) != nullptr;
    return numbersOf(stated ? origin->Attribute(attribute) : "0 0 0", 3);
  };
  const auto xyz = numbers_of_origin("xyz");
  const auto rpy = numbers_of_origin("rpy");
  if (!radius || !length || !xyz || !rpy) return {};
  const auto part = [&](const char* shape, double along) {
    TiXmlElement copy(element);
    // The direction of the shape's Z axis: the last column of Rz(yaw) Ry(pitch) Rx(roll).
    const auto [roll, pitch, yaw] = std::tuple((*rpy)[0], (*rpy)[1], (*rpy)[2]);
    const std::array<double, 3> axis{
        std::cos(roll) * std::sin(pitch) * std::cos(yaw) + std::sin(roll) * std::sin(yaw),
        std::cos(roll) * std::sin(pitch) * std::sin(yaw) - std::sin(roll) * std::cos(yaw),
        std::cos(roll) * std::cos(pitch)};
    TiXmlElement* moved = copy.FirstChildElement("origin");
    if (moved == nullptr) moved = copy.LinkEndChild(new TiXmlElement("origin"))->ToElement();
    moved->SetAttribute(
        "xyz", fmt::format("{} {} {}", (*xyz)[0] + along * axis[0], (*xyz)[1] + along * axis[1],
                           (*xyz)[2] + along * axis[2]));
    TiXmlElement* renamed = copy.FirstChildElement("geometry")->FirstChildElement("capsule");
    renamed->SetValue(shape);
    return copy;
  };
  return {part("cylinder", 0), part("sphere", -(*length)[0] / 2), part("sphere", (*length)[0] / 2)};
}

/// Splits capsules, which the parser's library does not know, into a cylinder of the length that
/// the capsule states, and a sphere at each end.
void replaceCapsules(TiXmlElement& robot) {
  for (TiXmlElement* link : childrenOf(robot, "link")) {
    for (const char* tag : {"visual", "collision"}) {
      for (TiXmlElement* element : childrenOf(*link, tag)) {
        const TiXmlElement* geometry = element->FirstChildElement("geometry");
        const TiXmlElement* capsule =
            geometry == nullptr ? nullptr : geometry->FirstChildElement("capsule");
        if (capsule == nullptr) continue;
        const std::vector<TiXmlElement> parts = partsOfCapsule(*element, *capsule);
        if (parts.empty()) continue;
        for (const TiXmlElement& part : parts) link->InsertBeforeChild(element, part);
        link->RemoveChild(element);
      }
    }
  }
}

}  // namespace

TiXmlElement* nextElement(TiXmlElement& element) {
  if (TiXmlElement* child = element.FirstChildElement()) return child;
  for (TiXmlElement* at = &element; at != nullptr; at = at->Parent()->ToElement()) {
    if (TiXmlElement* next = at->NextSiblingElement()) return next;
  }
  return nullptr;
}

std::optional<std::vector<double>> numbersOf(const char* text, std::size_t count) {
  if (text == nullptr) return std::nullopt;
  std::vector<double> numbers;
  std::string_view left(text);
  while (true) {
    left.remove_prefix(std::min(left.find_first_not_of(kBlanks), left.size()));
    if (left.empty()) break;
    double number = 0;
    if (left.front() == '+') left.remove_prefix(1);
    const auto [end, error] = std::from_chars(left.data(), left.data() + left.size(), number);
    if (error != std::errc{}) return std::nullopt;
    numbers.push_back(number);
    left.remove_prefix(static_cast<std::size_t>(end - left.data()));
  }
  if (numbers.size() != count) return std::nullopt;
  return numbers;
}

ParserText textForParser(TiXmlDocument& document, DescriptionPart part,
                         std::vector<std::string>& warnings) {
  ParserText prepared;
  TiXmlElement& robot = *document.FirstChildElement("robot");
  removeUnread(robot, part);
  Remarks remarks;
  tidyNumbers(robot, remarks);
  tidyMaterials(robot, remarks);
  remarks.appendTo(warnings);
  completeLimits(robot, prepared.without_limits);
  declareWorld(robot, warnings);
  replaceCapsules(robot);
  TiXmlPrinter printer;
  printer.SetStreamPrinting();
  document.Accept(&printer);
  prepared.text = printer.Str();
  return prepared;
}

}  // namespace galactic::bake
