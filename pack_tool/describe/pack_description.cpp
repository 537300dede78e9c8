#include "pack_tool/describe/pack_description.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "pack_tool/describe/asset_json.h"
#include "pack_tool/describe/json_parts.h"

namespace galactic::pack_tool {

namespace {

Json describeProvenance(const schema::Provenance& provenance) {
  Json json;
  json["tool"] = provenance.tool()->str();
  json["tool_version"] = provenance.tool_version()->str();
  json["options"] = Json::array();
  for (const auto* option : *provenance.options()) {
    json["options"].push_back({{"name", option->name()->str()}, {"value", option->value()->str()}});
  }
  json["sources"] = Json::array();
  for (const auto* source : *provenance.sources()) {
    json["sources"].push_back({{"name", source->name()->str()},
                               {"bytes", source->bytes()},
                               {"xxh3_128", describeHash(source->hash())}});
  }
  json["warnings"] = describeTexts(*provenance.warnings());
  return json;
}

}  // namespace

Json jsonNumber(float value) {
  if (!std::isfinite(value)) return nullptr;
  std::array<char, 32> text{};
  const auto printed = std::to_chars(text.data(), text.data() + text.size(), value);
  double shortest = 0;
  std::from_chars(text.data(), printed.ptr, shortest);
  // Rounding to double and then to float may, very rarely, miss; the float itself never does.
  return static_cast<float>(shortest) == value ? shortest : static_cast<double>(value);
}

std::string jsonText(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

Json describePack(const PackFile& pack, Detail detail) {
  Json json;
  json["file"] = pack.where();
  json["kind"] = packKindName(pack.kind());
  json["format_version"] = pack.header().format_version;
  json["bytes"] = pack.bytes().size();
  json["payload_xxh64"] = fmt::format("{:016x}", pack.header().payload_xxh64);
  json["provenance"] = describeProvenance(*pack.root().provenance());
  if (Json scene = describeScene(pack); !scene.is_null()) json["scene"] = std::move(scene);
  if (Json set = describeObjects(pack); !set.is_null()) json["object_set"] = std::move(set);
  if (Json robot = describeRobot(pack); !robot.is_null()) json["robot"] = std::move(robot);
  if (json.contains("scene") || json.contains("object_set") || json.contains("robot")) {
    json["render_meshes"] = describeRenderMeshes(pack);
  }
  if (Json set = describeEpisodes(pack, detail); !set.is_null()) {
    json["episode_set"] = std::move(set);
  }
  if (Json world = describeWorld(pack); !world.is_null()) json["world"] = std::move(world);
  if (Json texture = describeTexture(pack); !texture.is_null()) {
    json["texture"] = std::move(texture);
  }
  if (Json policy = describePolicy(pack); !policy.is_null()) json["policy"] = std::move(policy);
  return json;
}

}  // namespace galactic::pack_tool
