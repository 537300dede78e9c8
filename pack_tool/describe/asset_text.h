#pragma once
#include <string>

#include "pack_tool/describe/pack_description.h"

namespace galactic::pack_tool {

// What infoText tells of one kind of pack, from the part of describePack about it.

[[nodiscard]] std::string sceneText(const Json& scene);
[[nodiscard]] std::string objectsText(const Json& set);
[[nodiscard]] std::string robotText(const Json& robot);
[[nodiscard]] std::string episodesText(const Json& set);
[[nodiscard]] std::string worldText(const Json& world);
[[nodiscard]] std::string policyText(const Json& policy);
[[nodiscard]] std::string textureText(const Json& texture);
/// Of scenes, objects and robots; null: there are none.
[[nodiscard]] std::string renderMeshesText(const Json& render);

}  // namespace galactic::pack_tool
