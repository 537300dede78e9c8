#include "dataset/config/template_list.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "common/lower_case.h"
#include "dataset/config/dataset_paths.h"

namespace galactic::bake {
namespace {

/// "stages/room.stage_config.json" as "stages/room".
std::string_view withoutEnding(const DatasetTemplate& entry) {
  const std::string_view handle = entry.handle;
  const std::size_t slash = handle.rfind('/');
  const std::size_t name = slash == std::string_view::npos ? 0 : slash + 1;
  return handle.substr(name).starts_with(entry.name) ? handle.substr(0, name + entry.name.size())
                                                     : handle;
}

}  // namespace

void TemplateList::add(const DatasetTemplate& entry) {
  if (!by_handle_.try_emplace(entry.handle, entry).second) return;
  handles_of_name_.emplace(entry.name, entry.handle);
}

void TemplateList::addLayer(const std::string& handle, AttributeLayer layer) {
  by_handle_.at(handle).layers.push_back(std::move(layer));
}

void TemplateList::replace(DatasetTemplate entry) {
  const auto known = by_handle_.find(entry.handle);
  if (known == by_handle_.end()) return add(entry);
  entry.name = known->second.name;
  known->second = std::move(entry);
}

FoundTemplate TemplateList::find(std::string_view wanted) const {
  const auto exact = by_handle_.find(std::string(wanted));
  if (exact != by_handle_.end()) return {&exact->second, false};
  const auto [first, last] = handles_of_name_.equal_range(wanted);
  if (first != last) {
    const auto smaller = [](const auto& a, const auto& b) { return a.second < b.second; };
    return {&by_handle_.at(std::min_element(first, last, smaller)->second),
            std::next(first) != last};
  }
  const std::string lower = lowerCase(wanted);
  if (lower.empty()) return {};
  // The better the reason, the smaller its number.
  constexpr std::size_t kReasons = 3;
  std::array<FoundTemplate, kReasons> found;
  for (const auto& [handle, entry] : by_handle_) {
    const std::string candidate = lowerCase(handle);
    if (candidate.find(lower) == std::string::npos) continue;
    const std::string_view bare = withoutEnding(entry);
    const bool ends = bare.size() > wanted.size() && bare.ends_with(wanted) &&
                      bare[bare.size() - wanted.size() - 1] == '/';
    FoundTemplate& of_reason = found[bare == wanted ? 0 : (ends ? 1 : 2)];
    if (of_reason.found == nullptr) {
      of_reason.found = &entry;
    } else {
      of_reason.ambiguous = true;
    }
  }
  for (const FoundTemplate& candidate : found) {
    if (candidate.found != nullptr) return candidate;
  }
  return {};
}

}  // namespace galactic::bake
