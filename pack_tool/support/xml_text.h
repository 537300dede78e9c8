#pragma once
#include <string>
#include <string_view>

namespace galactic::pack_tool {

/// Text as it may stand in an attribute or between tags of XML 1.0. What cannot stand in XML at all
/// (control characters) becomes '?', bytes that are no UTF-8 become U+FFFD.
[[nodiscard]] std::string xmlEscaped(std::string_view text);

}  // namespace galactic::pack_tool
