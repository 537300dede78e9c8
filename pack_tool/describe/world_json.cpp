#include "pack_tool/describe/asset_json.h"
#include "pack_tool/describe/json_parts.h"

namespace galactic::pack_tool {

Json describeWorld(const PackFile& pack) {
  const schema::World* world = pack.root().asset_as_World();
  if (world == nullptr) return nullptr;
  Json json;
  json["packs"] = Json::array();
  for (const schema::PackReference* one : *world->packs()) {
    json["packs"].push_back({{"path", one->path()->str()},
                             {"kind", one->kind()->str()},
                             {"bytes", one->bytes()},
                             {"xxh3_128", describeHash(one->hash())}});
  }
  json["task"] = Json::array();
  if (world->task() == nullptr) return json;
  for (const schema::Option* one : *world->task()) {
    json["task"].push_back({{"name", one->name()->str()}, {"value", one->value()->str()}});
  }
  return json;
}

}  // namespace galactic::pack_tool
