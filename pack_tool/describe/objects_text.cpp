#include <fmt/format.h>

#include "pack_tool/describe/asset_text.h"
#include "pack_tool/describe/text_parts.h"
#include "pack_tool/support/text_table.h"

namespace galactic::pack_tool {

namespace {

/// Full extents of a box in millimeters.
std::string extentsOf(const Json& box) {
  const Json& half = box.at("half_extents");
  return fmt::format("{:.0f}x{:.0f}x{:.0f}", 2e3 * numberOf(half.at(0)), 2e3 * numberOf(half.at(1)),
                     2e3 * numberOf(half.at(2)));
}

std::vector<std::string> objectLine(const Json& object, const Json& radii) {
  const Json& quality = object.at("sphere_quality");
  const Json& volumes = object.at("box_volumes");
  const Json& poses = object.at("stable_poses");
  const double share = numberOf(volumes.at("volume")) / numberOf(volumes.at("axis_aligned_volume"));
  return {textOf(object.at("name")),
          extentsOf(object.at("box")),
          textOf(object.at("box").at("fit")),
          fmt::format("{:.3f}", share),
          std::to_string(object.at("spheres").size()),
          countsByRadius(object.at("spheres"), radii),
          millimetersOf(quality.at("gap")),
          millimetersOf(quality.at("protrusion")),
          quality.at("meets_tolerances").get<bool>() ? "yes" : "no",
          std::to_string(poses.size()),
          fmt::format("{:.2f}", numberOf(poses.at(0).at("likelihood"))),
          countOf(object.at("surface").at("triangles"))};
}

}  // namespace

std::string objectsText(const Json& set) {
  const Json& radii = set.at("radii");
  TextTable table(4);
  table.add({"name", "box (mm)", "fit", "/aabb", "spheres", "by radius", "gap (mm)",
             "protrusion (mm)", "met", "poses", "likeliest", "triangles"});
  for (const Json& object : set.at("objects")) table.add(objectLine(object, radii));
  return labeled("radii", radiiOf(radii) + " m") +
         labeled("objects", std::to_string(set.at("objects").size())) + table.text() +
         "    gap and protrusion: mean/p95/max; met: whether the tolerances are; /aabb: volume of "
         "the "
         "box by\n    that of the axis-aligned one\n";
}

}  // namespace galactic::pack_tool
