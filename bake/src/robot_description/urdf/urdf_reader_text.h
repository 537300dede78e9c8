#pragma once
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "robot_description/description.h"

class TiXmlDocument;
class TiXmlElement;

namespace galactic::bake {

/// The `count` numbers in `text`; none if it does not hold exactly this many.
[[nodiscard]] std::optional<std::vector<double>> numbersOf(const char* text, std::size_t count);

/// The next element in the text: its first child if it has one, else the one after it; null after
/// the last.
[[nodiscard]] TiXmlElement* nextElement(TiXmlElement& element);

/// The text of a URDF in a form that urdfdom accepts.
struct ParserText {
  std::string text;
  /// Revolute and prismatic joints for which the text states no limits.
  std::set<std::string> without_limits;
};

/// Repairs what other readers of URDFs accept and urdfdom does not: commas, tabs and line ends
/// between numbers, blanks around them, joints without <limit>, colors outside 0 to 1, materials
/// without a name, a link "world" that joints are attached to but nothing declares, and capsules.
/// Removes parts that are not read here and might make urdfdom refuse the file because of an
/// attribute: efforts and velocities, <dynamics>, <safety_controller>, <calibration> and, unless
/// wanted, <inertial>. `document` must have been parsed and have a <robot> element; it is changed
/// to match the returned text. Adds remarks for the user to `warnings`.
[[nodiscard]] ParserText textForParser(TiXmlDocument& document, DescriptionPart part,
                                       std::vector<std::string>& warnings);

}  // namespace galactic::bake
