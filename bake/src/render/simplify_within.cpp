#include "render/simplify_within.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/vec3d.h"
#include "distance/triangle_tree.h"

namespace galactic::bake {
namespace {

/// How often corners are kept before the piece stays as it is.
constexpr int kRoundsOfKeeping = 5;
/// Shares of the error that quadrics are asked for. On evenly curved surfaces a smaller one leaves
/// fewer triangles, because fewer corners have to be kept; on flat ones with edges a larger one
/// does.
constexpr std::array<double, 3> kSharesAsked{1, 0.5, 0.25};
/// A corner's color that differs by more from the mean of its neighbors' is a detail to keep, of
/// 255: about what an eye sees in a small image.
constexpr int kColorDetail = 12;

constexpr std::size_t kChannels = 3;

int channelOf(std::uint32_t color, std::size_t channel) {
  return static_cast<int>(color >> (8 * channel) & 0xFFU);
}

bool hasOneColor(const PartMesh& piece) {
  return std::all_of(piece.vertices.begin(), piece.vertices.end(), [&](const RenderVertex& v) {
    return v.color == piece.vertices.front().color;
  });
}

/// The corners whose color cannot be told from their neighbors'. Seams of colors are seams of
/// the surface and need no mark.
std::vector<bool> coloredDetails(const PartMesh& piece) {
  std::vector<bool> details(piece.vertices.size());
  if (hasOneColor(piece)) return details;
  std::vector<std::array<int, kChannels>> sums(piece.vertices.size());
  std::vector<int> counts(piece.vertices.size());
  for (const Triangle& triangle : piece.triangles) {
    for (std::size_t n = 0; n < 3; ++n) {
      for (const std::size_t other : {(n + 1) % 3, (n + 2) % 3}) {
        ++counts[triangle[n]];
        for (std::size_t c = 0; c < kChannels; ++c) {
          sums[triangle[n]][c] += channelOf(piece.vertices[triangle[other]].color, c);
        }
      }
    }
  }
  for (std::size_t n = 0; n < details.size(); ++n) {
    for (std::size_t c = 0; c < kChannels; ++c) {
      const int own = counts[n] * channelOf(piece.vertices[n].color, c);
      if (std::abs(own - sums[n][c]) > counts[n] * kColorDetail) details[n] = true;
    }
  }
  return details;
}

TriangleTree treeOf(const PartMesh& piece, const std::vector<Triangle>& triangles) {
  std::vector<Facet> facets;
  facets.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    facets.push_back({piece.vertices[t[0]].position, piece.vertices[t[1]].position,
                      piece.vertices[t[2]].position});
  }
  return TriangleTree(std::move(facets));
}

Vec3d middleOf(const PartMesh& piece, const Triangle& t) {
  return (widen(piece.vertices[t[0]].position) + widen(piece.vertices[t[1]].position) +
          widen(piece.vertices[t[2]].position)) *
         (1.0 / 3);
}

/// What became of a piece, for questions about how far the source lies from it. Neighbors in the
/// source lie near the same triangles, so what was found for a corner answers most questions about
/// the points around it without a search.
class SimplifiedSurface {
 public:
  /// Counts its work in `counted`.
  SimplifiedSurface(const PartMesh& piece, const std::vector<Triangle>& triangles,
                    MeasuredSimplified& counted)
      : piece_(piece),
        counted_(counted),
        tree_(treeOf(piece, triangles)),
        facet_near_(piece.vertices.size(), kNoFacet),
        survives_(piece.vertices.size()) {
    for (std::uint32_t n = 0; n < triangles.size(); ++n) {
      for (const std::uint32_t corner : triangles[n]) {
        facet_near_[corner] = n;
        survives_[corner] = true;
      }
    }
  }

  /// Whether a corner of the source lies no further than `distance` from the surface.
  bool cornerWithin(std::uint32_t corner, const Triangle& around, double distance) {
    if (survives_[corner]) return true;
    return within(widen(piece_.vertices[corner].position), around, distance, facet_near_[corner]);
  }

  /// The same for the middle of a triangle of the source.
  bool middleWithin(const Triangle& triangle, double distance) {
    std::uint32_t facet = kNoFacet;
    return within(middleOf(piece_, triangle), triangle, distance, facet);
  }

  /// The largest distance of the source's corners and middles, meters.
  [[nodiscard]] double largestDistance() const {
    double largest = 0;
    const auto raise = [&](const Vec3d& point, std::uint32_t hint) {
      const auto nearest = tree_.nearest(point, {.squared_enough = largest, .hint = hint});
      largest = std::max(largest, nearest.squared);
    };
    for (const Triangle& triangle : piece_.triangles) {
      for (const std::uint32_t corner : triangle) {
        if (!survives_[corner]) raise(widen(piece_.vertices[corner].position), facet_near_[corner]);
      }
      raise(middleOf(piece_, triangle), facet_near_[triangle[0]]);
    }
    return std::sqrt(largest);
  }

 private:
  /// Tries what is near the corners of `around` first; `facet` becomes one that is near enough.
  bool within(const Vec3d& point, const Triangle& around, double distance, std::uint32_t& facet) {
    const double squared = distance * distance;
    ++counted_.comparisons;
    std::uint32_t tried = kNoFacet;
    const auto is_near = [&](std::uint32_t candidate) {
      if (candidate == kNoFacet || candidate == tried) return false;
      tried = candidate;
      const Vec3d nearest = nearestOnFacet(point, tree_.facets()[candidate]);
      if (squaredNorm(nearest - point) > squared) return false;
      facet = candidate;
      return true;
    };
    if (is_near(facet)) return true;
    for (const std::uint32_t corner : around) {
      if (is_near(facet_near_[corner])) return true;
    }
    ++counted_.searches;
    const auto nearest =
        tree_.nearest(point, {.squared_limit = squared * kJustBeyond, .squared_enough = squared});
    if (nearest.facet == kNoFacet || nearest.squared > squared) return false;
    facet = nearest.facet;
    return true;
  }

  /// A search counts only what is nearer than its limit; what lies at the distance itself counts.
  static constexpr double kJustBeyond = 1 + 1e-9;

  const PartMesh& piece_;
  MeasuredSimplified& counted_;
  TriangleTree tree_;
  /// By corner of the source: a triangle of the surface that is near it, where one is known.
  std::vector<std::uint32_t> facet_near_;
  /// By corner of the source: whether it is a corner of the surface.
  std::vector<bool> survives_;
};

/// Whether all of the source lies within `allowed` meters of the surface; if not, marks in `kept`
/// the corners that are too far off.
bool keepFarCorners(const PartMesh& piece, SimplifiedSurface& surface, double allowed,
                    std::vector<bool>& kept) {
  bool near = true;
  // Those that were kept, too: the surface may have lost one whose neighbors all fell together.
  std::vector<bool> asked(piece.vertices.size());
  for (const Triangle& triangle : piece.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (asked[corner]) continue;
      asked[corner] = true;
      if (surface.cornerWithin(corner, triangle, allowed)) continue;
      near = false;
      if (kept[corner]) {
        for (const std::uint32_t neighbor : triangle) kept[neighbor] = true;
      }
      kept[corner] = true;
    }
  }
  for (const Triangle& triangle : piece.triangles) {
    if (surface.middleWithin(triangle, allowed)) continue;
    near = false;
    for (const std::uint32_t corner : triangle) kept[corner] = true;
  }
  return near;
}

/// What simplifies a piece again and again, asking for less and keeping more.
struct Keeping {
  const PartMesh& piece;
  /// How far a point may lie from the result, meters.
  double allowed = 0;
  /// The best so far, and the work that went into it.
  MeasuredSimplified& best;
};

/// Simplifies by what quadrics estimate as `asked`, and keeps corners until all of the piece is
/// near enough. Each round keeps more corners and so leaves more triangles: false when a round
/// leaves no fewer than the best, or when it takes too many of them.
bool improve(const Keeping& keeping, double asked, std::vector<bool> kept) {
  for (int round = 0; round <= kRoundsOfKeeping; ++round) {
    Simplified simplified = simplify(keeping.piece, asked, kept);
    const std::size_t left = simplified.triangles.size();
    if (left == 0 || left >= keeping.best.surface.triangles.size()) break;
    SimplifiedSurface surface(keeping.piece, simplified.triangles, keeping.best);
    if (!keepFarCorners(keeping.piece, surface, keeping.allowed, kept)) continue;
    simplified.error = surface.largestDistance();
    keeping.best.surface = std::move(simplified);
    return true;
  }
  return false;
}

}  // namespace

MeasuredSimplified simplifyWithin(const PartMesh& piece, double error) {
  const std::vector<bool> details = coloredDetails(piece);
  MeasuredSimplified best{.surface = {piece.triangles, 0}};
  bool found = false;
  for (const double share : kSharesAsked) {
    const bool better = improve({piece, error, best}, share * error, details);
    // A smaller share leaves more triangles to begin with: after one that does not help, none does.
    if (found && !better) break;
    found = found || better;
  }
  return best;
}

}  // namespace galactic::bake
