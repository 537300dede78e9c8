#include "pack_tool/support/xml_text.h"

#include <nlohmann/json.hpp>

#include "support/text/printable.h"

namespace galactic::pack_tool {

namespace {

/// Without bytes that are no UTF-8.
std::string validUtf8(std::string_view text) {
  const std::string quoted =
      nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return nlohmann::json::parse(quoted).get<std::string>();
}

}  // namespace

std::string xmlEscaped(std::string_view text) {
  // U+FFFE and U+FFFF are characters of UTF-8 and none of XML.
  constexpr std::string_view kNoCharacter = "\xef\xbf";
  const std::string valid = validUtf8(printable(text));
  std::string xml;
  xml.reserve(valid.size());
  for (std::size_t n = 0; n < valid.size(); ++n) {
    switch (valid[n]) {
      case '&':
        xml += "&amp;";
        break;
      case '<':
        xml += "&lt;";
        break;
      case '>':
        xml += "&gt;";
        break;
      case '"':
        xml += "&quot;";
        break;
      case '\'':
        xml += "&apos;";
        break;
      default:
        const bool is_last = n >= 2 && valid.compare(n - 2, 2, kNoCharacter) == 0;
        const auto byte = static_cast<unsigned char>(valid[n]);
        xml += is_last && byte >= 0xbe ? '\xbd' : valid[n];
    }
  }
  return xml;
}

}  // namespace galactic::pack_tool
