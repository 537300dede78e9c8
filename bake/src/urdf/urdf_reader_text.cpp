#include "urdf/urdf_reader_text.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <tuple>

namespace galactic::bake {
namespace {

/// Lists of numbers that the parser splits at blanks only.
constexpr std::array<std::string_view, 5> kNumberLists{"xyz", "rpy", "scale", "size", "rgba"};

/// Commas between the numbers of one kind of attribute: files that have any have many.
struct Commas {
  std::string attribute;
  /// Of the first of them.
  std::string sentence;
  std::size_t count = 0;
};

void countCommas(const TiXmlElement& element, const TiXmlAttribute& list,
                 std::vector<Commas>& commas) {
  const auto is_of_kind = [&](const Commas& known) { return known.attribute == list.Name(); };
  auto known = std::find_if(commas.begin(), commas.end(), is_of_kind);
  if (known == commas.end()) {
    known = commas.insert(commas.end(), {.attribute = list.Name(),
                                         .sentence = fmt::format(
                                             "line {}: {}=\"{}\" has commas, which count as blanks",
                                             element.Row(), list.Name(), list.Value())});
  }
  ++known->count;
}

/// Makes blanks of what else separates numbers in real files: commas (which are counted), tabs and
/// line ends. Returns whether anything changed.
bool separateByBlanks(TiXmlElement& element, std::vector<Commas>& commas) {
  bool changed = false;
  for (auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    const bool is_list =
        std::find(kNumberLists.begin(), kNumberLists.end(), a->Name()) != kNumberLists.end();
    std::string value = a->Value();
    if (!is_list || value.find_first_of(",\t\r\n") == std::string::npos) continue;
    if (value.find(',') != std::string::npos) countCommas(element, *a, commas);
    std::replace_if(
        value.begin(), value.end(),
        [](char c) { return c == ',' || c == '\t' || c == '\r' || c == '\n'; }, ' ');
    a->SetValue(value);
    changed = true;
  }
  return changed;
}

/// All elements of the document, one after the other.
bool separateAllByBlanks(TiXmlDocument& document, std::vector<std::string>& warnings) {
  bool changed = false;
  std::vector<Commas> commas;
  TiXmlElement* at = document.RootElement();
  while (at != nullptr) {
    changed = separateByBlanks(*at, commas) || changed;
    TiXmlElement* next = at->FirstChildElement();
    while (next == nullptr && at != nullptr) {
      next = at->NextSiblingElement();
      at = at->Parent() == nullptr ? nullptr : at->Parent()->ToElement();
    }
    at = next;
  }
  for (const Commas& kind : commas) {
    warnings.push_back(kind.count == 1
                           ? kind.sentence
                           : fmt::format("{} ({} times in the file)", kind.sentence, kind.count));
  }
  return changed;
}

std::string_view textOf(const TiXmlElement& element, const char* attribute) {
  const char* value = element.Attribute(attribute);
  return value == nullptr ? std::string_view() : std::string_view(value);
}

/// Gives the joints of `robot` what the parser wants of limits. Returns whether anything changed.
bool completeLimits(TiXmlElement& robot, std::set<std::string>& without_limits) {
  bool changed = false;
  for (auto* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const std::string_view type = textOf(*joint, "type");
    const bool needs_limits = type == "revolute" || type == "prismatic";
    TiXmlElement* limit = joint->FirstChildElement("limit");
    if (limit == nullptr && !needs_limits) continue;
    if (limit == nullptr) {
      limit = joint->LinkEndChild(new TiXmlElement("limit"))->ToElement();
      changed = true;
    }
    if (needs_limits && limit->Attribute("lower") == nullptr &&
        limit->Attribute("upper") == nullptr) {
      without_limits.emplace(textOf(*joint, "name"));
    }
    for (const char* unused : {"effort", "velocity"}) {
      if (limit->Attribute(unused) != nullptr) continue;
      limit->SetAttribute(unused, "0");
      changed = true;
    }
  }
  return changed;
}

/// Declares the link "world" where joints hang from it and no link has its name.
bool declareWorld(TiXmlElement& robot, std::vector<std::string>& warnings) {
  constexpr const char* kWorld = "world";
  for (auto* link = robot.FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    if (textOf(*link, "name") == kWorld) return false;
  }
  for (auto* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const TiXmlElement* parent = joint->FirstChildElement("parent");
    if (parent == nullptr || textOf(*parent, "link") != kWorld) continue;
    warnings.push_back(
        fmt::format("joint '{}': it hangs from a link '{}', which the file does not declare; it "
                    "counts as an empty link",
                    textOf(*joint, "name"), kWorld));
    TiXmlElement world("link");
    world.SetAttribute("name", kWorld);
    robot.InsertBeforeChild(robot.FirstChild(), world);
    return true;
  }
  return false;
}

/// What stands for the <visual> or <collision> of a capsule: copies of it with a cylinder and two
/// spheres at its ends. None where the text makes no sense; the parser then says so.
std::vector<TiXmlElement> partsOfCapsule(const TiXmlElement& element, const TiXmlElement& capsule) {
  const auto radius = numbersOf(capsule.Attribute("radius"), 1);
  const auto length = numbersOf(capsule.Attribute("length"), 1);
  const TiXmlElement* origin = element.FirstChildElement("origin");
  const auto numbersOfOrigin = [&](const char* attribute) {
    const bool stated = origin != nullptr && origin->Attribute(attribute) != nullptr;
    return numbersOf(stated ? origin->Attribute(attribute) : "0 0 0", 3);
  };
  const auto xyz = numbersOfOrigin("xyz");
  const auto rpy = numbersOfOrigin("rpy");
  if (!radius || !length || !xyz || !rpy) return {};
  const auto part = [&](const char* shape, double along) {
    TiXmlElement copy(element);
    // Where Z of the shape points: the last column of Rz(yaw) Ry(pitch) Rx(roll).
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

/// Takes capsules apart, which the parser's library does not know: a cylinder as long as the
/// capsule states, and a sphere at each end. Returns whether anything changed.
bool replaceCapsules(TiXmlElement& robot) {
  bool changed = false;
  for (auto* link = robot.FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    TiXmlElement* next = nullptr;
    for (auto* element = link->FirstChildElement(); element != nullptr; element = next) {
      next = element->NextSiblingElement();
      const TiXmlElement* geometry = element->FirstChildElement("geometry");
      const TiXmlElement* capsule =
          geometry == nullptr ? nullptr : geometry->FirstChildElement("capsule");
      if (capsule == nullptr) continue;
      const std::vector<TiXmlElement> parts = partsOfCapsule(*element, *capsule);
      if (parts.empty()) continue;
      for (const TiXmlElement& part : parts) link->InsertBeforeChild(element, part);
      link->RemoveChild(element);
      changed = true;
    }
  }
  return changed;
}

}  // namespace

std::optional<std::vector<double>> numbersOf(const char* text, std::size_t count) {
  if (text == nullptr) return std::nullopt;
  std::vector<double> numbers;
  std::string_view left(text);
  constexpr std::string_view kBlanks = " \t\r\n";
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

ParserText textForParser(TiXmlDocument& document, const std::string& text,
                         std::vector<std::string>& warnings) {
  ParserText prepared;
  bool changed = separateAllByBlanks(document, warnings);
  TiXmlElement& robot = *document.FirstChildElement("robot");
  changed = completeLimits(robot, prepared.without_limits) || changed;
  changed = declareWorld(robot, warnings) || changed;
  changed = replaceCapsules(robot) || changed;
  if (!changed) {
    prepared.text = text;
    return prepared;
  }
  TiXmlPrinter printer;
  document.Accept(&printer);
  prepared.text = printer.Str();
  return prepared;
}

}  // namespace galactic::bake
