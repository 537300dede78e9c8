#include "urdf/urdf_reader_text.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>
#include <array>
#include <string_view>

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

}  // namespace

ParserText textForParser(TiXmlDocument& document, const std::string& text,
                         std::vector<std::string>& warnings) {
  ParserText prepared;
  bool changed = separateAllByBlanks(document, warnings);
  TiXmlElement& robot = *document.FirstChildElement("robot");
  changed = completeLimits(robot, prepared.without_limits) || changed;
  changed = declareWorld(robot, warnings) || changed;
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
