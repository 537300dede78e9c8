#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "column_grid/triangle_interval.h"
#include "galactic/bake/column_engines.h"
#include "galactic/bake/parallel_for.h"

namespace galactic::bake {
namespace {

/// Distance from the ends of a piece at which its first and last heights are judged: more than the
/// rounding of a span's end, and less than anything that matters. Meters.
constexpr double kPulledIn = 1e-4;
/// A disagreement is judged in parts of about this length, meters, so that one that is a tie at one
/// end and due to the method at the other is split between the two.
constexpr double kPartLength = 0.01;
/// Maximum number of parts; longer pieces get longer parts.
constexpr double kMaxParts = 512;

/// Number of triangles that the casts of one column may test on average. The search tests a
/// triangle at each step (BulletCastOptions::step) at which its ball is at the triangle's height.
/// 128 such columns take about half a second on one core.
constexpr double kTestsPerColumn = 20'000;
/// At least this many columns are replayed, however many triangles are near them.
constexpr std::uint32_t kLeastColumns = 4;

/// A triangle near a sampled column, with the squared horizontal distance of its box and its range
/// of heights.
struct NearTriangle {
  std::uint32_t triangle = 0;
  double aside_squared = 0;
  std::array<double, 2> heights{};
};

struct SampledColumn {
  std::size_t index = 0;
  ColumnIndex at;
  std::vector<NearTriangle> near;
};

/// Scrambles a number (with the finalizer of SplitMix64), so that no pattern in the scene matches
/// the sample.
std::uint64_t scramble(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15U;
  value = (value ^ (value >> 30U)) * 0xbf58476d1ce4e5b9U;
  value = (value ^ (value >> 27U)) * 0x94d049bb133111ebU;
  return value ^ (value >> 31U);
}

/// One column from each of `wanted` equal shares of the columns with spans, in ascending order; all
/// of them if there are fewer.
std::vector<SampledColumn> chooseColumns(const Columns& columns, std::uint32_t wanted) {
  const std::size_t count = columns.frame.columnCount();
  std::uint64_t with_spans = 0;
  for (std::size_t c = 0; c < count; ++c) with_spans += columns.column(c).empty() ? 0U : 1U;
  const std::uint64_t shares = std::min<std::uint64_t>(wanted, with_spans);
  std::vector<SampledColumn> chosen;
  std::uint64_t rank = 0;
  for (std::size_t c = 0; c < count && chosen.size() < shares; ++c) {
    if (columns.column(c).empty()) continue;
    const std::uint64_t share = chosen.size();
    const std::uint64_t begin = share * with_spans / shares;
    const std::uint64_t end = (share + 1) * with_spans / shares;
    if (rank++ != begin + scramble(share) % (end - begin)) continue;
    SampledColumn column;
    column.index = c;
    column.at = {static_cast<std::uint32_t>(c % columns.frame.columns_x),
                 static_cast<std::uint32_t>(c / columns.frame.columns_x)};
    chosen.push_back(std::move(column));
  }
  return chosen;
}

/// Least and greatest coordinate of a triangle along an axis.
std::array<double, 2> extent(const std::array<Point, 3>& corners, std::size_t axis) {
  const auto [lo, hi] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
  return {lo, hi};
}

/// Cells first to last along one axis.
struct CellRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

/// The cells along an axis (whose first edge is at `min`) that a range of coordinates overlaps, and
/// one more on each side for rounding. Does not use the engines' function, because the check must
/// find what that one loses.
CellRange cellsWithin(const std::array<double, 2>& range, double min, const GridFrame& frame,
                      std::uint32_t count) {
  const auto spacing = static_cast<double>(frame.spacing);
  const double limit = static_cast<double>(count) - 1;
  const double first = std::floor((range[0] - min) / spacing) - 1;
  const double last = std::floor((range[1] - min) / spacing) + 1;
  return {static_cast<std::uint32_t>(std::clamp(first, 0.0, limit)),
          static_cast<std::uint32_t>(std::clamp(last, 0.0, limit))};
}

double outside(double value, const std::array<double, 2>& range) {
  return std::max({range[0] - value, value - range[1], 0.0});
}

/// Calls `visit` with each sampled column and each triangle that may be within `reach` of it. Makes
/// one pass over the mesh; for most triangles, the search among the columns, which are in ascending
/// order, ends at once.
template <class Visit>
void forEachNear(const TriangleMesh& mesh, const GridFrame& frame, double reach,
                 std::vector<SampledColumn>& columns, const Visit& visit) {
  const auto before = [](const SampledColumn& column, std::size_t index) {
    return column.index < index;
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<Point, 3> corners = pointsOf(mesh, mesh.triangles[t]);
    const std::array<double, 2> x = extent(corners, 0);
    const std::array<double, 2> y = extent(corners, 1);
    const std::array<double, 2> z = extent(corners, 2);
    const CellRange across = cellsWithin({x[0] - reach, x[1] + reach},
                                         static_cast<double>(frame.min_x), frame, frame.columns_x);
    const CellRange rows = cellsWithin({z[0] - reach, z[1] + reach},
                                       static_cast<double>(frame.min_z), frame, frame.columns_z);
    const auto from = [&](auto begin, std::size_t row) {
      return std::lower_bound(begin, columns.end(), row * frame.columns_x + across.first, before);
    };
    auto column = from(columns.begin(), rows.first);
    while (column != columns.end() && column->at.k <= rows.last) {
      if (column->at.i > across.last) {
        column = from(column, std::size_t{column->at.k} + 1);
      } else if (column->at.i < across.first) {
        column = from(column, column->at.k);
      } else {
        const double dx = outside(frame.centerX(column->at.i), x);
        const double dz = outside(frame.centerZ(column->at.k), z);
        const double aside_squared = dx * dx + dz * dz;
        if (aside_squared <= reach * reach) visit(*column, NearTriangle{t, aside_squared, y});
        ++column;
      }
    }
  }
}

/// Upper bound of the number of triangle tests that the casts of these columns take.
double testsOf(const TriangleMesh& mesh, const GridFrame& frame, double reach,
               std::vector<SampledColumn>& columns) {
  const auto step = static_cast<double>(BulletCastOptions().step);
  const double most = static_cast<double>(frame.heights.hi) - static_cast<double>(frame.heights.lo);
  double tests = 0;
  forEachNear(mesh, frame, reach, columns, [&](const SampledColumn&, const NearTriangle& near) {
    tests += std::min(most, near.heights[1] - near.heights[0] + 2 * reach) / step;
  });
  return tests;
}

/// The columns to replay, with the triangles within `reach` of each. There are `wanted` columns, or
/// fewer if too many triangles are within reach: a scan of a million triangles with a ball of half
/// a meter would take longer to check than to bake.
std::vector<SampledColumn> sampleOf(const TriangleMesh& mesh, const Columns& columns, double reach,
                                    std::uint32_t wanted) {
  std::vector<SampledColumn> sample = chooseColumns(columns, wanted);
  const double allowed = kTestsPerColumn * static_cast<double>(sample.size());
  const double tests = testsOf(mesh, columns.frame, reach, sample);
  if (tests > allowed && sample.size() > kLeastColumns) {
    const auto affordable =
        static_cast<std::uint32_t>(static_cast<double>(sample.size()) * (allowed / tests));
    sample = chooseColumns(columns, std::max(kLeastColumns, affordable));
  }
  forEachNear(mesh, columns.frame, reach, sample,
              [](SampledColumn& column, const NearTriangle& near) { column.near.push_back(near); });
  return sample;
}

/// The verdict of the true distance on the grid at one height, in ascending order of severity.
enum class Verdict { kTie, kRight, kWrong };

/// Judges one sampled column by brute force in double precision.
class Judge {
 public:
  Judge(const TriangleMesh& mesh, const GridFrame& frame, const SampledColumn& column,
        double tolerance)
      : mesh_(mesh),
        column_(column),
        x_(frame.centerX(column.at.i)),
        z_(frame.centerZ(column.at.k)),
        radius_(static_cast<double>(frame.radius)),
        tolerance_(tolerance) {}

  /// The verdict on a grid that calls `height` free or blocked.
  [[nodiscard]] Verdict at(double height, bool grid_says_free) const {
    // If the distance is greater than the radius plus the tolerance, or less than the radius minus
    // the tolerance, its exact value does not matter.
    const double reach = radius_ + 2 * tolerance_;
    const double inside = std::max(0.0, radius_ - 2 * tolerance_);
    double least = reach * reach;
    for (const NearTriangle& near : column_.near) {
      const double off = outside(height, near.heights);
      if (near.aside_squared + off * off >= least) continue;
      least = std::min(least, squaredDistance({x_, height, z_},
                                              pointsOf(mesh_, mesh_.triangles[near.triangle])));
      if (least < inside * inside) break;
    }
    const double clearance = std::sqrt(least) - radius_;
    if (std::abs(clearance) <= tolerance_) return Verdict::kTie;
    return (clearance > 0) == grid_says_free ? Verdict::kRight : Verdict::kWrong;
  }

 private:
  const TriangleMesh& mesh_;
  const SampledColumn& column_;
  double x_;
  double z_;
  double radius_;
  double tolerance_;
};

/// A range of heights in which neither the grid's nor the casts' answer changes.
struct Piece {
  double lo = 0;
  double hi = 0;
  bool grid_free = false;
  bool cast_free = false;

  [[nodiscard]] double length() const { return hi - lo; }
};

bool contains(std::span<const Span> spans, double height) {
  return std::any_of(spans.begin(), spans.end(), [&](const Span& span) {
    return static_cast<double>(span.lo) <= height && height <= static_cast<double>(span.hi);
  });
}

/// Cuts the heights at the ends of all spans of both, ascending.
std::vector<Piece> cutInPieces(const Span& heights, std::span<const Span> grid,
                               std::span<const Span> cast) {
  std::vector<float> cuts{heights.lo, heights.hi};
  for (const std::span<const Span> spans : {grid, cast}) {
    for (const Span& span : spans) {
      cuts.push_back(std::clamp(span.lo, heights.lo, heights.hi));
      cuts.push_back(std::clamp(span.hi, heights.lo, heights.hi));
    }
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const auto lo = static_cast<double>(cuts[i]);
    const auto hi = static_cast<double>(cuts[i + 1]);
    const double middle = 0.5 * (lo + hi);
    pieces.push_back({lo, hi, contains(grid, middle), contains(cast, middle)});
  }
  return pieces;
}

/// Judges a piece in equal parts: each part at its middle, the first and last also close to the
/// piece's ends. A part gets its most severe verdict. Adds the parts' lengths to `result`. Where
/// both methods agree, there can only be errors; the parts there are as long as the radius, because
/// most obstacles block twice that.
void judgePiece(const Judge& judge, const Piece& piece, double radius, CastCheck& result) {
  double by_method = 0;
  double ties = 0;
  const bool agreed = piece.grid_free == piece.cast_free;
  const double wanted = agreed ? radius : kPartLength;
  const auto count =
      static_cast<int>(std::clamp(std::ceil(piece.length() / wanted), 1.0, kMaxParts));
  const double part_length = piece.length() / count;
  const double pulled_in = std::min(kPulledIn, 0.25 * part_length);
  for (int part = 0; part < count; ++part) {
    const double middle = piece.lo + (part + 0.5) * part_length;
    Verdict verdict = judge.at(middle, piece.grid_free);
    if (part == 0) {
      verdict = std::max(verdict, judge.at(piece.lo + pulled_in, piece.grid_free));
    }
    if (part == count - 1) {
      verdict = std::max(verdict, judge.at(piece.hi - pulled_in, piece.grid_free));
    }
    if (verdict == Verdict::kWrong) {
      result.errors += part_length;
    } else if (!agreed) {
      (verdict == Verdict::kTie ? ties : by_method) += part_length;
    }
  }
  result.method += by_method;
  result.longest = std::max(result.longest, by_method);
  result.ties += ties;
  result.longest_tie = std::max(result.longest_tie, ties);
}

/// The tolerance, or two units in the last place of the greatest height if that is more, because
/// the ends of spans are floats.
double effectiveTolerance(const Span& heights, double tolerance) {
  const float greatest = std::max(std::abs(heights.lo), std::abs(heights.hi));
  const float unit = std::nextafter(greatest, std::numeric_limits<float>::infinity()) - greatest;
  return std::max(tolerance, 2 * static_cast<double>(unit));
}

CastCheck checkColumn(const TriangleMesh& mesh, const Columns& columns,
                      const SampledColumn& sampled, const BulletColumnCaster& caster,
                      double tolerance) {
  const GridFrame& frame = columns.frame;
  const std::vector<Span> cast = caster.column(frame, sampled.at);
  const Judge judge(mesh, frame, sampled, tolerance);
  CastCheck result;
  bool differs = false;
  for (const Piece& piece : cutInPieces(frame.heights, columns.column(sampled.index), cast)) {
    judgePiece(judge, piece, static_cast<double>(frame.radius), result);
    differs |= piece.grid_free != piece.cast_free && piece.length() > tolerance;
  }
  result.columns = 1;
  result.columns_differing = differs ? 1 : 0;
  result.compared = static_cast<double>(frame.heights.hi) - static_cast<double>(frame.heights.lo);
  return result;
}

void add(const CastCheck& one, CastCheck& sum) {
  sum.columns += one.columns;
  sum.columns_differing += one.columns_differing;
  sum.compared += one.compared;
  sum.method += one.method;
  sum.ties += one.ties;
  sum.errors += one.errors;
  sum.longest = std::max(sum.longest, one.longest);
  sum.longest_tie = std::max(sum.longest_tie, one.longest_tie);
}

}  // namespace

CastCheck checkWithCasts(const TriangleMesh& mesh, const Columns& columns,
                         const BulletColumnCaster& caster, const CastCheckOptions& options,
                         unsigned threads) {
  const GridFrame& frame = columns.frame;
  const double tolerance = effectiveTolerance(frame.heights, options.tie_tolerance);
  // Triangles farther away are more than the radius and the tolerance from every point of a column.
  const double reach = static_cast<double>(frame.radius) + 2 * tolerance;
  const std::vector<SampledColumn> sample = sampleOf(mesh, columns, reach, options.columns);
  std::vector<CastCheck> checks(sample.size());
  parallelFor(threads, sample.size(), [&](std::size_t n) {
    checks[n] = checkColumn(mesh, columns, sample[n], caster.another(), tolerance);
  });
  // Added in the order of the columns, on which floating-point sums depend.
  CastCheck result;
  for (const CastCheck& check : checks) add(check, result);
  return result;
}

}  // namespace galactic::bake
