#include "pack_tool/diff/grid_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

  void compareColumns(ColumnIndex cell) {
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

}  // namespace galactic::pack_tool
