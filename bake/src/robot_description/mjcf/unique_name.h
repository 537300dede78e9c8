#pragma once
#include <functional>
#include <set>
#include <string>

namespace galactic::bake {

using NameSet = std::set<std::string, std::less<>>;

/// `name`, with as many underscores appended as make it different from those in `taken`; adds it to
/// `taken`.
inline std::string uniqueName(std::string name, NameSet& taken) {
  while (!taken.insert(name).second) name += '_';
  return name;
}

}  // namespace galactic::bake
