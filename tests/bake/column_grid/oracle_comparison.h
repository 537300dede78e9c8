#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "galactic/bake/columns.h"
#include "support/oracles/column_oracle.h"

namespace galactic::test {

/// A surface whose distance is within this of the radius may fall on either side; meters.
inline constexpr double kTieTolerance = 2e-6;
/// How far a span end of the exact engine may be from the oracle's; meters. The engine computes in
/// floats relative to the triangle, and heights are floats.
inline constexpr double kEndTolerance = 1e-5;

/// What comparing columns with the oracle found.
struct Comparison {
  int columns = 0;
  /// Columns whose number of spans is not the same for radii of kTieTolerance less and more.
  int ties = 0;
  int spans = 0;
  /// Columns with an obstacle in them.
  int touching = 0;
  /// Ends further than kEndTolerance from the oracle's, but between those of the two radii.
  int steep_ends = 0;
  double greatest_error = 0;
  /// Of the offences, the first; empty if there are none.
  std::string offence;
};

/// Compares single columns of a grid with the oracle. In columns that are no ties the spans must be
/// the oracle's, one for one; in every column what is free for a slightly greater radius must be
/// free, and what is blocked for a slightly smaller one must be blocked.
class OracleComparison {
 public:
  OracleComparison(const ColumnOracle& oracle, const bake::Columns& columns)
      : oracle_(oracle), columns_(columns) {}

  void compare(std::uint32_t i, std::uint32_t k) {
    const bake::GridFrame& frame = columns_.frame;
    const double x = frame.centerX(i);
    const double z = frame.centerZ(k);
    const auto radius = static_cast<double>(frame.radius);
    const auto found = columns_.column(columns_.index(i, k));
    const Free greater = oracle_.freeSpans(x, z, frame, radius + kTieTolerance);
    const Free smaller = oracle_.freeSpans(x, z, frame, radius - kTieTolerance);
    ++result_.columns;
    result_.touching += smaller.size() == 1 &&
                                smaller[0].lo < static_cast<double>(frame.heights.lo) + 1e-9 &&
                                smaller[0].hi > static_cast<double>(frame.heights.hi) - 1e-9
                            ? 0
                            : 1;
    for (const bake::HeightInterval& span : greater) {
      if (!isInside(span, found)) offend(i, k, "blocked where a greater sphere fits");
    }
    for (const Span& span : found) {
      const bake::HeightInterval wide{static_cast<double>(span.lo), static_cast<double>(span.hi)};
      if (!isInside(wide, smaller)) offend(i, k, "free where a smaller sphere touches");
    }
    if (greater.size() != smaller.size()) {
      ++result_.ties;
      return;
    }
    const Free exact = oracle_.freeSpans(x, z, frame, radius);
    if (exact.size() != found.size()) {
      offend(i, k,
             "has " + std::to_string(found.size()) + " spans, the oracle finds " +
                 std::to_string(exact.size()));
      return;
    }
    for (std::size_t s = 0; s < found.size(); ++s) {
      compareEnd(i, k, static_cast<double>(found[s].lo),
                 {smaller[s].lo, exact[s].lo, greater[s].lo});
      compareEnd(i, k, static_cast<double>(found[s].hi),
                 {smaller[s].hi, exact[s].hi, greater[s].hi});
      ++result_.spans;
    }
  }

  [[nodiscard]] const Comparison& result() const { return result_; }

 private:
  using Free = std::vector<bake::HeightInterval>;

  /// The same end for three radii.
  struct Ends {
    double smaller = 0;
    double exact = 0;
    double greater = 0;
  };

  template <class Spans>
  static bool isInside(const bake::HeightInterval& span, const Spans& spans) {
    return std::any_of(spans.begin(), spans.end(), [&](const auto& outer) {
      return static_cast<double>(outer.lo) <= span.lo + kEndTolerance &&
             static_cast<double>(outer.hi) >= span.hi - kEndTolerance;
    });
  }

  void compareEnd(std::uint32_t i, std::uint32_t k, double found, const Ends& expected) {
    const double error = std::abs(found - expected.exact);
    if (error <= kEndTolerance) {
      result_.greatest_error = std::max(result_.greatest_error, error);
      return;
    }
    const auto [least, most] = std::minmax({expected.smaller, expected.greater});
    if (found >= least - kEndTolerance && found <= most + kEndTolerance) {
      ++result_.steep_ends;
      return;
    }
    offend(i, k, "an end is wrong by " + std::to_string(error) + " m");
  }

  void offend(std::uint32_t i, std::uint32_t k, const std::string& what) {
    if (!result_.offence.empty()) return;
    result_.offence = "column (" + std::to_string(i) + ", " + std::to_string(k) + ") at x " +
                      std::to_string(columns_.frame.centerX(i)) + ", z " +
                      std::to_string(columns_.frame.centerZ(k)) + ": " + what;
  }

  const ColumnOracle& oracle_;
  const bake::Columns& columns_;
  Comparison result_;
};

/// Compares every `step`th column.
inline Comparison compareWithOracle(const ColumnOracle& oracle, const bake::Columns& columns,
                                    std::size_t step = 1) {
  OracleComparison comparison(oracle, columns);
  for (std::size_t at = 0; at < columns.frame.columnCount(); at += step) {
    comparison.compare(static_cast<std::uint32_t>(at % columns.frame.columns_x),
                       static_cast<std::uint32_t>(at / columns.frame.columns_x));
  }
  return comparison.result();
}

}  // namespace galactic::test
