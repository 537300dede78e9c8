#include "pack_tool/describe/text_parts.h"

#include <fmt/format.h>

#include <cstdint>
#include <limits>

#include "pack_tool/support/text_table.h"
#include "support/text/counted.h"
#include "support/text/printable.h"

namespace galactic::pack_tool {

std::string textOf(const Json& json) { return printable(json.get<std::string>()); }

std::string countOf(const Json& json) { return grouped(json.get<std::uint64_t>()); }

std::string countedOf(const Json& count, std::string_view one) {
  return fmt::format("{} {}", countOf(count), nounFor(count.get<std::uint64_t>(), one));
}

double numberOf(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

std::string lengthOf(const Json& json) { return fmt::format("{}", numberOf(json)); }

std::string pointOf(const Json& json) {
  return fmt::format("({:.4f}, {:.4f}, {:.4f})", numberOf(json.at(0)), numberOf(json.at(1)),
                     numberOf(json.at(2)));
}

std::string millimetersOf(const Json& lengths) {
  if (lengths.is_null()) return "-";
  return fmt::format("{:.1f}/{:.1f}/{:.1f}", 1e3 * numberOf(lengths.at("mean")),
                     1e3 * numberOf(lengths.at("p95")), 1e3 * numberOf(lengths.at("max")));
}

std::string countsByRadius(const Json& spheres, const Json& radii) {
  std::string text;
  for (std::size_t n = radii.size(); n-- > 0;) {
    std::size_t count = 0;
    for (const Json& sphere : spheres)
      if (sphere.at("radius") == radii.at(n)) ++count;
    text += fmt::format("{}{}", text.empty() ? "" : "+", count);
  }
  return text;
}

std::string radiiOf(const Json& radii) {
  std::string text;
  for (std::size_t n = radii.size(); n-- > 0;) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", lengthOf(radii.at(n)));
  }
  return text;
}

}  // namespace galactic::pack_tool
