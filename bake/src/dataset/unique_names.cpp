#include "dataset/unique_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace galactic::bake {
namespace {

/// The last `count` parts as one name.
std::string lastOf(const std::vector<std::string>& parts, std::size_t count) {
  const std::size_t first = parts.size() - std::min(count, parts.size());
  return fmt::format("{}", fmt::join(std::span(parts).subspan(first), "_"));
}

}  // namespace

std::vector<std::string> uniqueNames(const std::vector<std::vector<std::string>>& paths) {
  // Of longer paths all parts are taken at once.
  constexpr std::size_t kMostParts = 7;
  std::vector<std::string> names(paths.size());
  std::set<std::string> taken;
  for (std::size_t count = 1; count <= kMostParts; ++count) {
    std::map<std::string, unsigned> users;
    for (const auto& parts : paths) ++users[lastOf(parts, count)];
    for (std::size_t n = 0; n < paths.size(); ++n) {
      const std::string name = lastOf(paths[n], count);
      if (!names[n].empty() || users[name] != 1 || !taken.insert(name).second) continue;
      names[n] = name;
    }
  }
  // SCENE.glb beside SCENE/SCENE.glb: a number tells them apart.
  for (std::size_t n = 0; n < paths.size(); ++n) {
    if (!names[n].empty()) continue;
    const std::string whole = lastOf(paths[n], paths[n].size());
    std::string name = whole;
    for (unsigned number = 2; !taken.insert(name).second; ++number) {
      name = fmt::format("{}_{}", whole, number);
    }
    names[n] = std::move(name);
  }
  return names;
}

}  // namespace galactic::bake
