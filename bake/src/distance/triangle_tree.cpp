#include "distance/triangle_tree.h"

#include <cmath>
#include <cstddef>
#include <utility>

namespace galactic::bake {

/// What building a tree needs of a facet, in one place, because the facets themselves are scattered
/// in memory.
struct PartedFacet {
  /// The three floats of a corner and an unused one, so that they are compared as one vector.
  using Quad [[gnu::vector_size(16)]] = float;

  /// A box that is empty until it is grown.
  struct Extent {
    Quad min = Quad{} + HUGE_VALF;
    Quad max = Quad{} - HUGE_VALF;

    void grow(const Extent& other) {
      min = other.min < min ? other.min : min;
      max = max < other.max ? other.max : max;
    }
    /// Half of the box's surface, to which the probability that a search enters the box is
    /// proportional.
    [[nodiscard]] double halfSurface() const {
      const Vec3d size = widen(toVec3(max)) - widen(toVec3(min));
      return size.x * size.y + size.y * size.z + size.z * size.x;
    }
  };

  PartedFacet(const Facet& corners, std::uint32_t number) : index(number) {
    const Vec3d mean = (widen(corners[0]) + widen(corners[1]) + widen(corners[2])) * (1.0 / 3);
    middle = {mean.x, mean.y, mean.z};
    for (const Vec3& corner : corners) {
      const Quad at{corner.x, corner.y, corner.z, 0};
      extent.grow({at, at});
    }
  }

  [[nodiscard]] static Vec3 toVec3(const Quad& quad) { return {quad[0], quad[1], quad[2]}; }

  std::array<double, 3> middle{};
  /// Index in the mesh.
  std::uint32_t index;
  Extent extent;
};

namespace {

using Extent = PartedFacet::Extent;

constexpr std::uint32_t kFacetsPerLeaf = 4;
/// At least the sum of kDeepest and the depth of a halving tree over fewer than 2^32 facets.
constexpr std::size_t kStack = 80;
/// Below this depth, facets are halved by number, so that the search's stack is large enough.
constexpr std::uint32_t kDeepest = 40;
constexpr std::size_t kBins = 16;

/// The range of the facets' middles along each axis.
struct MiddleRange {
  explicit MiddleRange(std::span<const PartedFacet> facets) {
    for (const PartedFacet& facet : facets) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        min[axis] = std::min(min[axis], facet.middle[axis]);
        max[axis] = std::max(max[axis], facet.middle[axis]);
      }
    }
  }

  [[nodiscard]] double size(std::size_t axis) const { return max[axis] - min[axis]; }

  [[nodiscard]] std::size_t longestAxis() const {
    if (size(0) >= size(1) && size(0) >= size(2)) return 0;
    return size(1) >= size(2) ? 1 : 2;
  }

  /// The bin, of kBins along an axis, that holds the facet's middle; the first one if all middles
  /// are the same.
  [[nodiscard]] std::size_t binOf(const PartedFacet& facet, std::size_t axis) const {
    const double whole = size(axis) > 0 ? size(axis) : 1;
    const double share = (facet.middle[axis] - min[axis]) / whole;
    return std::min(kBins - 1, static_cast<std::size_t>(share * static_cast<double>(kBins)));
  }

  std::array<double, 3> min{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  std::array<double, 3> max{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
};

/// A split of facets: those whose middle is in a bin below `bin`, of kBins along `axis`, come
/// first.
struct Parting {
  std::size_t axis = 0;
  std::size_t bin = 0;
  double cost = HUGE_VAL;
};

struct Bin {
  Extent extent;
  std::size_t count = 0;

  void add(const Bin& other) {
    extent.grow(other.extent);
    count += other.count;
  }
  [[nodiscard]] double cost() const {
    return count == 0 ? HUGE_VAL : extent.halfSurface() * static_cast<double>(count);
  }
};

/// The split along an axis that costs searches least: the sum over both sides of surface times
/// number of facets (Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007).
Parting bestParting(const std::array<Bin, kBins>& bins, std::size_t axis) {
  // A split before an empty bin is the same as before the next one.
  std::array<double, kBins> left_cost{};
  Bin left = bins[0];
  for (std::size_t n = 1; n < kBins; ++n) {
    if (bins[n].count == 0) continue;
    left_cost[n] = left.cost();
    left.add(bins[n]);
  }
  Parting best{axis, 0, HUGE_VAL};
  Bin right;
  for (std::size_t n = kBins - 1; n > 0; --n) {
    if (bins[n].count == 0) continue;
    right.add(bins[n]);
    const double cost = left_cost[n] + right.cost();
    if (cost < best.cost) best = {axis, n, cost};
  }
  return best;
}

/// The best split along any axis. Its cost is infinite if no split separates the facets.
Parting bestParting(std::span<const PartedFacet> facets, const MiddleRange& middles) {
  std::array<std::array<Bin, kBins>, 3> bins;
  for (const PartedFacet& facet : facets) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Bin& bin = bins[axis][middles.binOf(facet, axis)];
      bin.extent.grow(facet.extent);
      ++bin.count;
    }
  }
  Parting best;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Parting parting = bestParting(bins[axis], axis);
    if (parting.cost < best.cost) best = parting;
  }
  return best;
}

/// Splits the facets of a node in two. Returns the size of the first part.
std::size_t part(std::span<PartedFacet> facets, std::uint32_t depth) {
  const MiddleRange middles(facets);
  const Parting best = depth < kDeepest ? bestParting(facets, middles) : Parting{};
  if (best.cost < HUGE_VAL) {
    const auto middle = std::partition(facets.begin(), facets.end(), [&](const PartedFacet& facet) {
      return middles.binOf(facet, best.axis) < best.bin;
    });
    return static_cast<std::size_t>(middle - facets.begin());
  }
  const std::size_t axis = middles.longestAxis();
  const std::size_t half = facets.size() / 2;
  std::nth_element(facets.begin(), facets.begin() + static_cast<std::ptrdiff_t>(half), facets.end(),
                   [&](const PartedFacet& a, const PartedFacet& b) {
                     const double at_a = a.middle[axis];
                     const double at_b = b.middle[axis];
                     return at_a != at_b ? at_a < at_b : a.index < b.index;
                   });
  return half;
}

}  // namespace

Vec3d nearestOnFacet(const Vec3d& p, const Facet& facet) {
  const Vec3d a = widen(facet[0]);
  const Vec3d b = widen(facet[1]);
  const Vec3d c = widen(facet[2]);
  const Vec3d ab = b - a;
  const Vec3d ac = c - a;
  const Vec3d ap = p - a;
  const double d1 = dot(ab, ap);
  const double d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3d bp = p - b;
  const double d3 = dot(ab, bp);
  const double d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  const Vec3d cp = p - c;
  const double d5 = dot(ab, cp);
  const double d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  const double to_c = d4 - d3;
  const double to_b = d5 - d6;
  if (va <= 0 && to_c >= 0 && to_b >= 0) return b + (c - b) * (to_c / (to_c + to_b));
  const double sum = va + vb + vc;
  // A triangle without area may pass the edge tests by rounding.
  if (!(sum > 0)) return a;
  return a + ab * (vb / sum) + ac * (vc / sum);
}

TriangleTree::TriangleTree(std::vector<Facet> facets) : facets_(std::move(facets)) {
  std::vector<PartedFacet> parted;
  parted.reserve(facets_.size());
  for (const Facet& facet : facets_) {
    parted.emplace_back(facet, static_cast<std::uint32_t>(parted.size()));
  }
  nodes_.reserve(facets_.size());
  leaves_.reserve(facets_.size());
  facet_of_leaf_.reserve(facets_.size());
  if (!parted.empty()) build(parted, 0);
}

void TriangleTree::build(std::span<PartedFacet> facets, std::uint32_t depth) {
  const std::size_t at = nodes_.size();
  Extent extent;
  for (const PartedFacet& facet : facets) extent.grow(facet.extent);
  nodes_.push_back(
      {.min = PartedFacet::toVec3(extent.min), .max = PartedFacet::toVec3(extent.max)});
  if (facets.size() <= kFacetsPerLeaf) {
    // Splitting does not preserve order, so it is made unique here, in the leaves, where it
    // matters.
    std::sort(facets.begin(), facets.end(),
              [](const PartedFacet& a, const PartedFacet& b) { return a.index < b.index; });
    nodes_[at].first = static_cast<std::uint32_t>(leaves_.size());
    nodes_[at].count = static_cast<std::uint32_t>(facets.size());
    for (const PartedFacet& facet : facets) {
      leaves_.push_back(facets_[facet.index]);
      facet_of_leaf_.push_back(facet.index);
    }
    return;
  }
  const std::size_t first_part = part(facets, depth);
  build(facets.first(first_part), depth + 1);
  nodes_[at].first = static_cast<std::uint32_t>(nodes_.size());
  build(facets.subspan(first_part), depth + 1);
}

NearestPoint TriangleTree::nearest(const Vec3d& p, const SearchLimits& limits) const {
  NearestPoint best{limits.squared_limit, {}, kNoFacet};
  const auto consider = [&](const Facet& facet, std::uint32_t index) {
    const Vec3d q = nearestOnFacet(p, facet);
    const double squared = squaredNorm(q - p);
    if (squared < best.squared) best = {squared, q, index};
  };
  if (limits.hint != kNoFacet) consider(facets_[limits.hint], limits.hint);
  if (nodes_.empty()) return best;
  // Boxes are compared in single precision. This factor exceeds their rounding.
  constexpr double kRounding = 1 - 1e-5;
  const Vec3 from = narrow(p);
  std::array<std::pair<std::uint32_t, float>, kStack> stack;
  std::size_t depth = 0;
  stack[depth++] = {0U, nodes_[0].squaredDistance(from)};
  while (depth > 0 && best.squared > limits.squared_enough) {
    const auto [at, squared] = stack[--depth];
    if (static_cast<double>(squared) * kRounding >= best.squared) continue;
    const Node& node = nodes_[at];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        consider(leaves_[i], facet_of_leaf_[i]);
      }
      continue;
    }
    std::pair<std::uint32_t, float> near{at + 1, nodes_[at + 1].squaredDistance(from)};
    std::pair<std::uint32_t, float> far{node.first, nodes_[node.first].squaredDistance(from)};
    if (far.second < near.second) std::swap(near, far);
    stack[depth++] = far;
    stack[depth++] = near;
  }
  return best;
}

}  // namespace galactic::bake
