#include "plan/plan_outcome.h"

#include <algorithm>

namespace galactic::bake {

const char* nameOf(PackState state) {
  switch (state) {
    case PackState::kBaked:
      return "baked";
    case PackState::kUnchanged:
      return "unchanged";
    case PackState::kElsewhere:
      return "elsewhere";
    case PackState::kFailed:
      return "failed";
    case PackState::kPlanned:
      break;
  }
  return "planned";
}

std::vector<std::string> texturePacks(const Json& entry) {
  std::vector<std::string> packs;
  const Json::json_pointer hashes("/render_meshes/shared_textures");
  if (!entry.is_object() || !entry.contains(hashes)) return packs;
  for (const Json& hash : entry.at(hashes)) {
    packs.push_back("textures/" + hash.get<std::string>() + ".pack");
  }
  return packs;
}

std::size_t PlanOutcome::count(PackState state) const {
  return static_cast<std::size_t>(
      std::count_if(packs.begin(), packs.end(),
                    [state](const PackOutcome& pack) { return pack.state == state; }));
}

}  // namespace galactic::bake
