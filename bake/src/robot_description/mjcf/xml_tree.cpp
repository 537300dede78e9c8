#include "robot_description/mjcf/xml_tree.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>

namespace galactic::bake {
namespace {

XmlElement converted(const TiXmlElement& element, const std::string& where) {
  XmlElement own;
  own.name = element.Value();
  own.place = fmt::format("{}:{}", where, element.Row());
  for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    own.attributes.emplace_back(a->Name(), a->Value());
  }
  for (const auto* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    own.children.push_back(converted(*child, where));
  }
  return own;
}

}  // namespace

const std::string* XmlElement::find(std::string_view attribute) const {
  for (const auto& [key, value] : attributes) {
    if (key == attribute) return &value;
  }
  return nullptr;
}

Result<XmlElement> parseXml(const std::string& text, const std::string& where) {
  TiXmlDocument document;
  document.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  if (document.Error()) {
    const std::string place =
        document.ErrorRow() == 0 ? where : fmt::format("{}:{}", where, document.ErrorRow());
    std::string_view reason = document.ErrorDesc();
    while (reason.ends_with('.')) reason.remove_suffix(1);
    return fail(ErrorCode::kInvalidInput, place,
                fmt::format("it is not well-formed XML: {}; repair or generate it again", reason));
  }
  const TiXmlElement* root = document.RootElement();
  if (root == nullptr) {
    return fail(ErrorCode::kInvalidInput, where,
                "it has no XML element; repair or generate it again");
  }
  return converted(*root, where);
}

}  // namespace galactic::bake
