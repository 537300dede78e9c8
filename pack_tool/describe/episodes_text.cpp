#include <fmt/format.h>

#include "pack_tool/describe/asset_text.h"
#include "pack_tool/describe/text_parts.h"
#include "pack_tool/support/text_table.h"

namespace galactic::pack_tool {

namespace {

/// Least, mean and greatest.
std::string spreadOf(const Json& spread) {
  if (spread.is_null()) return "none";
  return fmt::format("{:.6g} to {:.6g}, {:.3g} on average", numberOf(spread.at("min")),
                     numberOf(spread.at("max")), numberOf(spread.at("mean")));
}

std::string namesOf(const Json& names) {
  std::string text;
  for (const Json& name : names) text += (text.empty() ? "" : ", ") + textOf(name);
  return text.empty() ? "none" : text;
}

}  // namespace

std::string episodesText(const Json& set) {
  TextTable scenes(4);
  scenes.add({"scene", "episodes"});
  for (const Json& scene : set.at("scenes")) {
    scenes.add({textOf(scene.at("name")), countOf(scene.at("episodes"))});
  }
  TextTable objects(4);
  objects.add({"object", "placed", "as target"});
  for (const Json& object : set.at("objects")) {
    objects.add({textOf(object.at("name")), countOf(object.at("placements")),
                 countOf(object.at("targets"))});
  }
  const Json& robot = set.at("robot");
  return labeled("name", textOf(set.at("name"))) +
         labeled("episodes", countOf(set.at("episode_count"))) +
         labeled("robot", robot.is_null() ? "any" : textOf(robot)) +
         labeled("start joints", namesOf(set.at("start_joints"))) +
         labeled("objects", spreadOf(set.at("objects_per_episode")) + " per episode") +
         labeled("to the goal", spreadOf(set.at("target_to_goal")) + " m") + scenes.text() +
         objects.text();
}

}  // namespace galactic::pack_tool
