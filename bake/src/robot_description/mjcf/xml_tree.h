#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "galactic/error.h"

namespace galactic::bake {

/// An XML element with its content, except text and comments.
struct XmlElement {
  std::string name;
  /// In the order of the text.
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<XmlElement> children;
  /// File and line, for messages.
  std::string place;

  /// The value of an attribute; null if absent.
  [[nodiscard]] const std::string* find(std::string_view attribute) const;
};

/// Parses XML that has passed checkRobotText, and returns its outermost element. Use it in a
/// process of its own: broken XML may crash or hang the parser. `where` names the file in messages.
/// Fails with kInvalidInput if the XML is not well-formed.
[[nodiscard]] Result<XmlElement> parseXml(const std::string& text, const std::string& where);

}  // namespace galactic::bake
