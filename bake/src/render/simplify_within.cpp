#include "render/simplify_within.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/vec3d.h"
#include "distance/triangle_tree.h"

namespace galactic::bake {
namespace {

/// Number of attempts to keep corners before giving up on an asked error.
constexpr int kRoundsOfKeeping = 5;
/// Shares of the allowed error to ask of the quadrics. A smaller share leaves fewer triangles on
/// evenly curved surfaces, because fewer corners must be kept; a larger one does on flat surfaces
/// with edges.
constexpr std::array<double, 3> kSharesAsked{1, 0.5, 0.25};
/// A corner whose color differs from the mean of its neighbors' by more than this, of 255, is a
/// detail to keep. About what the eye can see in a small image.
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

/// Flags the corners whose color cannot be inferred from their neighbors. Color seams are seams of
/// the mesh and need no flag.
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

/// A simplified piece to which the distance of source points is measured. Neighbors in the source
/// lie near the same triangles, so the triangle found for a corner settles most points around it
/// without a search.
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

  /// Whether a corner of the source lies within `distance` of the surface.
  bool cornerWithin(std::uint32_t corner, const Triangle& around, double distance) {
    if (survives_[corner]) return true;
    return within(widen(piece_.vertices[corner].position), around, distance, facet_near_[corner]);
  }

  /// Whether the middle of a source triangle lies within `distance` of the surface.
  bool middleWithin(const Triangle& triangle, double distance) {
    std::uint32_t facet = kNoFacet;
    return within(middleOf(piece_, triangle), triangle, distance, facet);
  }

  /// The largest distance of the source's corners and middles to the surface, meters.
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
  /// Whether `point` lies within `distance`. Tries `facet` and facets near the corners of `around`
  /// first, and sets `facet` to one that is near enough.
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

  /// A search finds only what is nearer than its limit, but points exactly at the distance also
  /// count.
  static constexpr double kJustBeyond = 1 + 1e-9;

  const PartMesh& piece_;
  MeasuredSimplified& counted_;
  TriangleTree tree_;
  /// For each corner of the source, a triangle of the surface near it, if one is known.
  std::vector<std::uint32_t> facet_near_;
  /// For each corner of the source, whether it is a corner of the surface.
  std::vector<bool> survives_;
};

/// Whether all checked points of the source lie within `allowed` meters of the surface. Marks the
/// corners that do not in `kept`.
bool keepFarCorners(const PartMesh& piece, SimplifiedSurface& surface, double allowed,
                    std::vector<bool>& kept) {
  bool near = true;
  // Checks kept corners, too: the surface may have lost one if all its neighbors collapsed.
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

/// The state of repeated attempts to simplify a piece.
struct Keeping {
  const PartMesh& piece;
  /// How far a point may lie from the result, meters.
  double allowed = 0;
  /// The best result so far, and the work spent on it.
  MeasuredSimplified& best;
};

/// Simplifies with the error `asked` of the quadrics, and keeps more and more corners until all of
/// the piece is near enough. Each round leaves more triangles. Returns false if a round leaves no
/// fewer triangles than the best result, or after too many rounds.
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
    // A smaller share leaves more triangles to begin with, so after one that does not help, no
    // other will.
    if (found && !better) break;
    found = found || better;
  }
  return best;
}

}  // namespace galactic::bake
