#pragma once
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

class TiXmlDocument;

namespace galactic::bake {

/// `count` numbers, or none when there are not so many.
[[nodiscard]] std::optional<std::vector<double>> numbersOf(const char* text, std::size_t count);

/// The text of a URDF as urdfdom takes it.
struct ParserText {
  std::string text;
  /// Revolute and prismatic joints whose limits the text does not state.
  std::set<std::string> without_limits;
};

/// Makes up for what other readers of URDFs accept and urdfdom does not: commas, tabs and line ends
/// between numbers, joints without <limit>, limits without effort and velocity (which nobody here
/// uses), a link "world" to which joints are attached although nothing declares it, and capsules.
/// `document` is `text`, parsed, with a <robot> element; both stay as they are where nothing lacks.
/// What is worth knowing is added to `warnings`.
[[nodiscard]] ParserText textForParser(TiXmlDocument& document, const std::string& text,
                                       std::vector<std::string>& warnings);

}  // namespace galactic::bake
