#include "pack_tool/diff/asset_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "pack_tool/describe/text_parts.h"

namespace galactic::pack_tool {

namespace {

/// What tells how an object or a group of links was made, not what is simulated.
constexpr std::array<const char*, 4> kMadeBy{"box_volumes", "sphere_quality", "import", "surface"};

/// One side, taken apart.
// NOLINTNEXTLINE(bugprone-exception-escape): moving JSON does not throw; its checks are asserts.
struct AssetParts {
  bool is_robot = false;
  Json provenance;
  Json content;
  /// The list whose elements have spheres, and its name.
  const char* list = nullptr;
};

/// Moves what kMadeBy names from the elements of `list` to a list of its own.
Json takeMadeBy(Json& list) {
  Json taken = Json::array();
  for (Json& element : list) {
    Json part{{"name", element.at("name")}};
    for (const char* key : kMadeBy) {
      if (!element.contains(key)) continue;
      part[key] = std::move(element[key]);
      element.erase(key);
    }
    taken.push_back(std::move(part));
  }
  return taken;
}

/// Pairs of groups as one entry each: what two groups do to each other.
Json pairKinds(const Json& pairs_by_kind) {
  Json kinds = Json::object();
  for (const auto& [kind, pairs] : pairs_by_kind.items()) {
    for (const Json& pair : pairs) {
      kinds[fmt::format("{} and {}", pair.at(0).get<std::string>(),
                        pair.at(1).get<std::string>())] = kind;
    }
  }
  return kinds;
}

AssetParts takeApart(Json description) {
  AssetParts parts;
  parts.is_robot = description.contains("robot");
  parts.list = parts.is_robot ? "groups" : "objects";
  parts.provenance = std::move(description.at("provenance"));
  parts.content = std::move(description.at(parts.is_robot ? "robot" : "object_set"));
  parts.provenance[parts.list] = takeMadeBy(parts.content.at(parts.list));
  if (parts.is_robot) {
    parts.provenance["surfaces"] = std::move(parts.content.at("surfaces"));
    parts.content.erase("surfaces");
    parts.content["group_pairs"] = pairKinds(parts.content.at("group_pairs"));
  }
  return parts;
}

double distance(const Json& a, const Json& b) {
  double square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    square += std::pow(numberOf(a.at(axis)) - numberOf(b.at(axis)), 2);
  }
  return std::sqrt(square);
}

std::string countsText(const Json& spheres, const Json& radii) {
  return fmt::format("{} ({})", spheres.size(), countsByRadius(spheres, radii));
}

/// How two lists of spheres differ, in a few words: first their numbers.
std::optional<FieldDifference> compareSpheres(const std::string& field,
                                              const DescribedPair& spheres,
                                              const DescribedPair& radii, double tolerance) {
  const std::string a = countsText(spheres.a, radii.a);
  const std::string b = countsText(spheres.b, radii.b);
  if (a != b) return FieldDifference{field, a, b};
  std::size_t moved = 0;
  double farthest = 0;
  for (std::size_t n = 0; n < spheres.a.size(); ++n) {
    const double way = distance(spheres.a[n].at("center"), spheres.b[n].at("center"));
    if (way <= tolerance) continue;
    ++moved;
    farthest = std::max(farthest, way);
  }
  if (moved == 0) return std::nullopt;
  return FieldDifference{field, a,
                         fmt::format("{}, {} moved by up to {:.3g} m", b, moved, farthest)};
}

std::set<std::string> namesIn(const Json& list) {
  std::set<std::string> names;
  for (const Json& element : list) names.insert(element.at("name").get<std::string>());
  return names;
}

/// Drops the elements that only one side has, each as one difference.
void pairByName(const char* list, DescribedPair& pair, std::vector<FieldDifference>& differences) {
  const std::set<std::string> names_a = namesIn(pair.a);
  const std::set<std::string> names_b = namesIn(pair.b);
  const auto drop = [](Json& from, const std::set<std::string>& wanted) {
    Json kept = Json::array();
    for (Json& element : from) {
      if (wanted.contains(element.at("name").get<std::string>()))
        kept.push_back(std::move(element));
    }
    from = std::move(kept);
  };
  for (const std::string& name : names_a) {
    if (names_b.contains(name)) continue;
    differences.push_back({fmt::format("{}.{}", list, name), "present", "none"});
  }
  for (const std::string& name : names_b) {
    if (names_a.contains(name)) continue;
    differences.push_back({fmt::format("{}.{}", list, name), "none", "present"});
  }
  drop(pair.a, names_b);
  drop(pair.b, names_a);
}

/// Takes the spheres out of paired elements, whose names are unique, and compares them.
void compareSphereLists(const char* list, DescribedPair& elements, const DescribedPair& radii,
                        double tolerance, std::vector<FieldDifference>& differences) {
  const auto by_name = [](const Json& a, const Json& b) { return a.at("name") < b.at("name"); };
  std::sort(elements.a.begin(), elements.a.end(), by_name);
  std::sort(elements.b.begin(), elements.b.end(), by_name);
  for (std::size_t n = 0; n < std::min(elements.a.size(), elements.b.size()); ++n) {
    const std::string field =
        fmt::format("{}.{}.spheres", list, elements.a[n].at("name").get<std::string>());
    const DescribedPair spheres{std::move(elements.a[n].at("spheres")),
                                std::move(elements.b[n].at("spheres"))};
    elements.a[n].erase("spheres");
    elements.b[n].erase("spheres");
    if (auto difference = compareSpheres(field, spheres, radii, tolerance)) {
      differences.push_back(std::move(*difference));
    }
  }
}

}  // namespace

void compareAssets(DescribedPair packs, const DiffOptions& options, PackDifference& difference) {
  AssetParts a = takeApart(std::move(packs.a));
  AssetParts b = takeApart(std::move(packs.b));
  const char* const list = a.list;
  if (options.scope == DiffScope::kEverything) {
    DescribedPair made{std::move(a.provenance.at(list)), std::move(b.provenance.at(list))};
    // That one side lacks them is told once, with the content.
    std::vector<FieldDifference> ignored;
    pairByName(list, made, ignored);
    a.provenance[list] = std::move(made.a);
    b.provenance[list] = std::move(made.b);
    difference.provenance = compareFields(a.provenance, b.provenance, 0);
  }
  DescribedPair elements{std::move(a.content.at(list)), std::move(b.content.at(list))};
  pairByName(list, elements, difference.content);
  compareSphereLists(list, elements, {a.content.at("radii"), b.content.at("radii")},
                     options.tolerance, difference.content);
  a.content[list] = std::move(elements.a);
  b.content[list] = std::move(elements.b);
  append(difference.content, compareFields(a.content, b.content, options.tolerance));
  if (!a.is_robot) return;
  // Actions, observations and recordings know joints and positions by their numbers.
  for (const char* numbered : {"positions", "controlled_joints"}) {
    append(difference.content,
           compareOrder(numbered, a.content.at(numbered), b.content.at(numbered)));
  }
}

}  // namespace galactic::pack_tool
