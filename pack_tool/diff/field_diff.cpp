#include "pack_tool/diff/field_diff.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace galactic::pack_tool {

namespace {

std::string leafText(const Json& json) {
  if (json.is_string()) return json.get<std::string>();
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The key that tells the elements of a list apart, none when they go by position.
const char* keyOfList(const Json& list) {
  const auto have = [&list](const char* key) {
    return !list.empty() && std::ranges::all_of(list, [key](const Json& element) {
      return element.is_object() && element.contains(key);
    });
  };
  for (const char* key : {"pack", "name", "region", "path"}) {
    if (have(key)) return key;
  }
  // Spheres and episodes have these, too, where they tell nothing apart.
  for (const char* key : {"radius", "scene"}) {
    if (!have(key)) continue;
    std::unordered_set<std::string> values;
    for (const Json& element : list) values.insert(leafText(element.at(key)));
    if (values.size() == list.size()) return key;
  }
  return nullptr;
}

/// What `key` says of the element, which is taken out of it. A pack may have several entries: each
/// is of one of its objects, by name.
std::string takeName(Json& element, const char* key) {
  std::string name = leafText(element.at(key));
  element.erase(key);
  if (std::string_view(key) != "pack" || !element.contains("name")) return name;
  name += '.' + leafText(element.at("name"));
  element.erase("name");
  return name;
}

std::string extended(const std::string& path, const std::string& step) {
  return path.empty() ? step : path + '.' + step;
}

/// A value that has no parts.
struct Leaf {
  /// "baked.crate.grids.0.spans"
  std::string path;
  Json value;
  FieldTolerance tolerance;
};

/// Lists the leaves of a value, in order.
class LeafList {
 public:
  explicit LeafList(const ToleranceOf& tolerance_of) : tolerance_of_(tolerance_of) {}

  /// `keys` is `path` without what tells the elements of a list apart.
  void add(const Json& json, const std::string& path, const std::string& keys) {
    if (json.is_object()) {
      for (const auto& [key, value] : json.items()) {
        add(value, extended(path, key), extended(keys, key));
      }
    } else if (json.is_array()) {
      addList(json, path, keys);
    } else {
      const FieldTolerance tolerance = tolerance_of_(keys);
      if (!tolerance.is_ignored) leaves_.push_back({path, json, tolerance});
    }
  }

  [[nodiscard]] std::vector<Leaf> take() { return std::move(leaves_); }

 private:
  /// A key that occurs again gets its number.
  void addList(const Json& list, const std::string& path, const std::string& keys) {
    const char* key = keyOfList(list);
    std::unordered_map<std::string, std::size_t> seen;
    for (std::size_t n = 0; n < list.size(); ++n) {
      Json value = list[n];
      const std::string name = key == nullptr ? std::to_string(n) : takeName(value, key);
      const std::size_t number = ++seen[name];
      // {"name": ..., "value": ...} reads best as one leaf.
      if (value.is_object() && value.size() == 1 && value.contains("value")) value = value["value"];
      add(value, extended(path, number > 1 ? fmt::format("{}#{}", name, number) : name), keys);
    }
  }

  const ToleranceOf& tolerance_of_;
  std::vector<Leaf> leaves_;
};

std::vector<Leaf> leavesOf(const Json& json, const ToleranceOf& tolerance_of) {
  LeafList list(tolerance_of);
  list.add(json, "", "");
  return list.take();
}

/// Where each path stands. Of equal paths the first counts.
std::unordered_map<std::string_view, std::size_t> placesOf(const std::vector<Leaf>& leaves) {
  std::unordered_map<std::string_view, std::size_t> places;
  for (std::size_t n = 0; n < leaves.size(); ++n) places.try_emplace(leaves[n].path, n);
  return places;
}

double shareFor(const Leaf& leaf, const Json& other) {
  const bool are_whole = leaf.value.is_number_integer() && other.is_number_integer();
  return are_whole ? leaf.tolerance.share_of_whole_numbers : leaf.tolerance.share_of_fractions;
}

bool isSame(const Leaf& leaf, const Json& other) {
  if (leaf.value == other) return true;
  if (!leaf.value.is_number() || !other.is_number()) return false;
  const bool are_whole = leaf.value.is_number_integer() && other.is_number_integer();
  const double a = leaf.value.get<double>();
  const double b = other.get<double>();
  const double absolute = are_whole ? 0 : leaf.tolerance.absolute;
  const double more = leaf.tolerance.is_upper_bound ? b - a : std::abs(b - a);
  return more <= std::max(absolute, shareFor(leaf, other) * std::abs(a));
}

/// A's value, with what it allows B to be.
std::string allowedText(const Leaf& leaf, const Json& other) {
  std::string text = leafText(leaf.value);
  if (!leaf.value.is_number() || !other.is_number()) return text;
  if (leaf.tolerance.is_upper_bound) text = "at most " + text;
  // What rounds differently with another compiler is not worth a word.
  constexpr double kNotable = 1e-6;
  const double share = shareFor(leaf, other);
  return share > kNotable ? fmt::format("{} within {:g} %", text, share * 100) : text;
}

std::vector<std::string> namesOf(const Json& list) {
  std::vector<std::string> names;
  for (const Json& element : list) names.push_back(leafText(element.at("name")));
  return names;
}

/// The names in `list` that `other` has, too, in the order of `list`.
std::vector<std::string> commonNames(const Json& list, const Json& other) {
  std::vector<std::string> names = namesOf(list);
  const std::vector<std::string> others = namesOf(other);
  const std::unordered_set<std::string> wanted(others.begin(), others.end());
  std::erase_if(names, [&wanted](const std::string& name) { return !wanted.contains(name); });
  return names;
}

}  // namespace

std::vector<FieldDifference> compareFields(const Json& a, const Json& b,
                                           const ToleranceOf& tolerance_of) {
  const std::vector<Leaf> leaves_a = leavesOf(a, tolerance_of);
  const std::vector<Leaf> leaves_b = leavesOf(b, tolerance_of);
  const auto places_a = placesOf(leaves_a);
  const auto places_b = placesOf(leaves_b);
  std::vector<FieldDifference> differences;
  for (const Leaf& leaf : leaves_a) {
    const auto other = places_b.find(leaf.path);
    if (other == places_b.end()) {
      differences.push_back({leaf.path, leafText(leaf.value), "none"});
      continue;
    }
    const Json& value = leaves_b[other->second].value;
    if (isSame(leaf, value)) continue;
    differences.push_back({leaf.path, allowedText(leaf, value), leafText(value)});
  }
  for (const Leaf& leaf : leaves_b) {
    if (!places_a.contains(leaf.path)) {
      differences.push_back({leaf.path, "none", leafText(leaf.value)});
    }
  }
  return differences;
}

std::vector<FieldDifference> compareFields(const Json& a, const Json& b, double tolerance) {
  return compareFields(a, b, [tolerance](std::string_view /*keys*/) {
    return FieldTolerance{.absolute = tolerance};
  });
}

std::vector<FieldDifference> compareOrder(const std::string& field, const Json& a, const Json& b) {
  const std::vector<std::string> names_a = commonNames(a, b);
  const std::vector<std::string> names_b = commonNames(b, a);
  if (names_a == names_b) return {};
  return {{field + ".order", fmt::format("{}", fmt::join(names_a, ", ")),
           fmt::format("{}", fmt::join(names_b, ", "))}};
}

void append(std::vector<FieldDifference>& to, const std::vector<FieldDifference>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace galactic::pack_tool
