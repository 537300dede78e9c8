#include "pack_tool/describe/asset_text.h"
#include "pack_tool/describe/text_parts.h"
#include "pack_tool/support/text_table.h"

namespace galactic::pack_tool {

std::string worldText(const Json& world) {
  TextTable table(4);
  table.add({"pack", "kind", "bytes", "XXH3-128"});
  for (const Json& pack : world.at("packs")) {
    const Json& hash = pack.at("xxh3_128");
    table.add({textOf(pack.at("path")), textOf(pack.at("kind")), countOf(pack.at("bytes")),
               hash.is_null() ? "not recorded" : textOf(hash)});
  }
  std::string task;
  for (const Json& option : world.at("task")) {
    if (!task.empty()) task += ", ";
    task += textOf(option.at("name")) + " " + textOf(option.at("value"));
  }
  return labeled("packs", countOf(Json(world.at("packs").size()))) +
         labeled("task", task.empty() ? "as galactic-run has it" : task) + table.text();
}

}  // namespace galactic::pack_tool
