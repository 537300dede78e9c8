#include "pack_tool/diff/pack_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace galactic::pack_tool {

namespace {

double heightOf(const Span& span) {
  return static_cast<double>(span.hi) - static_cast<double>(span.lo);
}

double totalHeight(const std::vector<Span>& spans) {
  double height = 0;
  for (const Span& span : spans) height += heightOf(span);
  return height;
}

/// Compares the grids of one GridDifference; keeps the sums that end up in it.
class GridComparison {
 public:
  GridComparison(const ColumnGrid& a, const ColumnGrid& b, double tolerance)
      : a_(a), b_(b), tolerance_(tolerance) {
    result_.radius = a.radius();
  }

  GridDifference run() {
    compareFrames();
    if (!result_.frame.empty()) return std::move(result_);
    for (std::uint32_t k = 0; k < a_.columnsZ(); ++k) {
      for (std::uint32_t i = 0; i < a_.columnsX(); ++i) compareColumns({i, k});
    }
    if (result_.ends > 0) result_.mean_end = end_sum_ / static_cast<double>(result_.ends);
    return std::move(result_);
  }

 private:
  void compareFrames() {
    const ColumnGridLayout& a = a_.layout();
    const ColumnGridLayout& b = b_.layout();
    compareLength("spacing", a.spacing, b.spacing, 0);
    compareLength("min_x", a.min_x, b.min_x, tolerance_);
    compareLength("min_z", a.min_z, b.min_z, tolerance_);
    compareLength("heights.lo", a.heights.lo, b.heights.lo, tolerance_);
    compareLength("heights.hi", a.heights.hi, b.heights.hi, tolerance_);
    compareCount("columns_x", a.columns_x, b.columns_x);
    compareCount("columns_z", a.columns_z, b.columns_z);
  }

  void compareLength(const char* field, float a, float b, double tolerance) {
    if (std::abs(static_cast<double>(a) - static_cast<double>(b)) <= tolerance) return;
    result_.frame.push_back({field, fmt::format("{}", a), fmt::format("{}", b)});
  }

  void compareCount(const char* field, std::uint32_t a, std::uint32_t b) {
    if (a != b) result_.frame.push_back({field, std::to_string(a), std::to_string(b)});
  }

  void compareColumns(Cell cell) {
    readSpans(a_, cell, spans_a_);
    readSpans(b_, cell, spans_b_);
    ++result_.columns;
    if (spans_a_ == spans_b_) return;

    const double common = commonHeight(spans_a_, spans_b_);
    const double only_a = totalHeight(spans_a_) - common;
    const double only_b = totalHeight(spans_b_) - common;
    const double cell_area = std::pow(static_cast<double>(a_.spacing()), 2);
    result_.free_only_in_a += only_a * cell_area;
    result_.free_only_in_b += only_b * cell_area;

    if (spans_a_.size() != spans_b_.size()) {
      ++result_.count_differs;
    } else if (compareEnds()) {
      ++result_.ends_differ;
    } else {
      return;
    }
    remember({cell, columnCenter(a_, cell), spans_a_.size(), spans_b_.size(), only_a + only_b});
  }

  /// Whether an end of the current columns, which have equally many spans, differs.
  bool compareEnds() {
    const std::uint64_t before = result_.ends;
    for (std::size_t s = 0; s < spans_a_.size(); ++s) {
      compareEnd(spans_a_[s].lo, spans_b_[s].lo);
      compareEnd(spans_a_[s].hi, spans_b_[s].hi);
    }
    return result_.ends > before;
  }

  void compareEnd(float a, float b) {
    const double difference = std::abs(static_cast<double>(a) - static_cast<double>(b));
    if (difference <= tolerance_) return;
    ++result_.ends;
    end_sum_ += difference;
    result_.largest_end = std::max(result_.largest_end, difference);
  }

  /// Keeps the worst columns sorted; of equal ones the first found comes first.
  void remember(const ColumnDifference& column) {
    const auto smaller = [](const ColumnDifference& left, const ColumnDifference& right) {
      return left.height > right.height;
    };
    auto& worst = result_.worst;
    worst.insert(std::upper_bound(worst.begin(), worst.end(), column, smaller), column);
    if (worst.size() > kWorstColumns) worst.pop_back();
  }

  const ColumnGrid& a_;
  const ColumnGrid& b_;
  double tolerance_;
  GridDifference result_;
  double end_sum_ = 0;
  std::vector<Span> spans_a_;
  std::vector<Span> spans_b_;
};

std::string leafText(const Json& json) {
  if (json.is_string()) return json.get<std::string>();
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The key that tells the elements of a list apart, none when they go by position.
const char* keyOfList(const Json& list) {
  for (const char* key : {"name", "region", "path"}) {
    const auto has_key = [key](const Json& element) {
      return element.is_object() && element.contains(key);
    };
    if (!list.empty() && std::all_of(list.begin(), list.end(), has_key)) return key;
  }
  return nullptr;
}

/// Values with their paths.
using Leaves = std::vector<std::pair<std::string, Json>>;

/// All leaves of a JSON value with their paths, in order. Lists are told apart by their keys; a
/// repeated key gets its number.
void flatten(const Json& json, const std::string& path, Leaves& leaves) {
  const auto extended = [&path](const std::string& step) {
    return path.empty() ? step : path + '.' + step;
  };
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) flatten(value, extended(key), leaves);
  } else if (json.is_array()) {
    const char* key = keyOfList(json);
    std::unordered_map<std::string, std::size_t> seen;
    for (std::size_t n = 0; n < json.size(); ++n) {
      const std::string name = key == nullptr ? std::to_string(n) : leafText(json[n].at(key));
      const std::size_t number = ++seen[name];
      const std::string step = extended(number > 1 ? fmt::format("{}#{}", name, number) : name);
      Json value = json[n];
      if (key != nullptr) value.erase(key);
      // {"name": ..., "value": ...} reads best as one leaf.
      if (value.is_object() && value.size() == 1 && value.contains("value")) value = value["value"];
      flatten(value, step, leaves);
    }
  } else {
    leaves.emplace_back(path, json);
  }
}

bool sameLeaf(const Json& a, const Json& b, double tolerance) {
  if (a.is_number_float() && b.is_number_float()) {
    return std::abs(a.get<double>() - b.get<double>()) <= tolerance;
  }
  return a == b;
}

}  // namespace

double commonHeight(const std::vector<Span>& a, const std::vector<Span>& b) {
  double common = 0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const Span overlap{std::max(a[i].lo, b[j].lo), std::min(a[i].hi, b[j].hi)};
    if (overlap.lo < overlap.hi) common += heightOf(overlap);
    if (a[i].hi < b[j].hi) {
      ++i;
    } else {
      ++j;
    }
  }
  return common;
}

GridDifference compareGrids(const ColumnGrid& a, const ColumnGrid& b, double tolerance) {
  return GridComparison(a, b, tolerance).run();
}

std::vector<FieldDifference> compareFields(const Json& a, const Json& b, double tolerance) {
  Leaves leaves_a;
  Leaves leaves_b;
  flatten(a, "", leaves_a);
  flatten(b, "", leaves_b);
  const auto places_of = [](const Leaves& leaves) {
    std::unordered_map<std::string_view, std::size_t> places;
    // Of equal paths the first counts.
    for (std::size_t n = 0; n < leaves.size(); ++n) places.try_emplace(leaves[n].first, n);
    return places;
  };
  const auto places_a = places_of(leaves_a);
  const auto places_b = places_of(leaves_b);
  std::vector<FieldDifference> differences;
  for (const auto& [path, value] : leaves_a) {
    const auto other = places_b.find(path);
    if (other == places_b.end()) {
      differences.push_back({path, leafText(value), "none"});
      continue;
    }
    const Json& value_b = leaves_b[other->second].second;
    if (!sameLeaf(value, value_b, tolerance)) {
      differences.push_back({path, leafText(value), leafText(value_b)});
    }
  }
  for (const auto& [path, value] : leaves_b) {
    if (!places_a.contains(path)) differences.push_back({path, "none", leafText(value)});
  }
  return differences;
}

}  // namespace galactic::pack_tool
