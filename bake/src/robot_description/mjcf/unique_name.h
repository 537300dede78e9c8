#pragma once
#include <functional>
#include <set>
#include <string>

namespace galactic::bake {

using NameSet = std::set<std::string, std::less<>>;

/// `name`, or with underscores behind it what is not in `taken` yet, and is then.
inline std::string uniqueName(std::string name, NameSet& taken) {
  while (!taken.insert(name).second) name += '_';
  return name;
}

}  // namespace galactic::bake
