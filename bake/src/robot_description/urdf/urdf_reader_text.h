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

/// `count` numbers, or none when there are not so many.
[[nodiscard]] std::optional<std::vector<double>> numbersOf(const char* text, std::size_t count);

/// The element that follows in the text, that inside before that behind; null after the last.
[[nodiscard]] TiXmlElement* nextElement(TiXmlElement& element);

/// The text of a URDF as urdfdom takes it.
struct ParserText {
  std::string text;
  /// Revolute and prismatic joints whose limits the text does not state.
  std::set<std::string> without_limits;
};

/// Makes up for what other readers of URDFs accept and urdfdom does not: commas, tabs and line ends
/// between numbers, blanks around them, joints without <limit>, colors beyond 0 to 1, materials
/// without a name, a link "world" to which joints are attached although nothing declares it, and
/// capsules. Leaves out what nobody here reads, which urdfdom would refuse over an attribute:
/// efforts and velocities, <dynamics>, <safety_controller>, <calibration> and, unless they are
/// wanted, <inertial>. `document`, parsed, with a <robot> element, becomes what the text says. What
/// is worth knowing is added to `warnings`.
[[nodiscard]] ParserText textForParser(TiXmlDocument& document, DescriptionPart part,
                                       std::vector<std::string>& warnings);

}  // namespace galactic::bake
