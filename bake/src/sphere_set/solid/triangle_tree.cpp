#include "sphere_set/solid/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace galactic::bake::sphere_set {
namespace {

constexpr std::uint32_t kFacetsPerLeaf = 4;
/// More than kDeepest and the depth of a halving tree over fewer than 2^32 facets.
constexpr std::size_t kStack = 80;

double component(const Vec3d& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

int longestAxis(const Vec3d& size) {
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

/// Deeper than this, facets are halved by number, so that the search's stack suffices.
constexpr std::uint32_t kDeepest = 40;
constexpr std::size_t kBins = 16;

/// Half of a box's surface: how often a search has to look into it, but for a factor.
double halfSurface(const Box& box) {
  const Vec3d size = box.size();
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// Where facets are parted: those whose middle lies in a bin below `bin` of kBins along `axis`.
struct Parting {
  int axis = 0;
  std::size_t bin = 0;
  double cost = HUGE_VAL;
};

struct Bin {
  Box box;
  std::size_t count = 0;
};

std::size_t binOf(const Vec3d& middle, int axis, const Box& of_middles) {
  const double from = component(of_middles.min, axis);
  const double share = (component(middle, axis) - from) / (component(of_middles.max, axis) - from);
  return std::min(kBins - 1, static_cast<std::size_t>(share * static_cast<double>(kBins)));
}

/// The parting of bins along an axis that searches pay least for: the surface of each side times
/// its facets (Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007).
Parting bestParting(const std::array<Bin, kBins>& bins, int axis) {
  std::array<double, kBins> left_cost{};
  Bin left;
  const auto add = [](Bin& to, const Bin& bin) {
    if (bin.count == 0) return;
    to.box.grow(bin.box.min);
    to.box.grow(bin.box.max);
    to.count += bin.count;
  };
  const auto cost_of = [](const Bin& bin) {
    return bin.count == 0 ? HUGE_VAL : halfSurface(bin.box) * static_cast<double>(bin.count);
  };
  for (std::size_t n = 1; n < kBins; ++n) {
    add(left, bins[n - 1]);
    left_cost[n] = cost_of(left);
  }
  Parting best{axis, 0, HUGE_VAL};
  Bin right;
  for (std::size_t n = kBins - 1; n > 0; --n) {
    add(right, bins[n]);
    const double cost = left_cost[n] + cost_of(right);
    if (cost < best.cost) best = {axis, n, cost};
  }
  return best;
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
  // A triangle without area that the edge tests let pass by rounding.
  if (!(sum > 0)) return a;
  return a + ab * (vb / sum) + ac * (vc / sum);
}

TriangleTree::TriangleTree(std::vector<Facet> facets) : facets_(std::move(facets)) {
  const auto count = static_cast<std::uint32_t>(facets_.size());
  std::vector<Vec3d> middles;
  middles.reserve(count);
  for (const Facet& f : facets_) {
    middles.push_back((widen(f[0]) + widen(f[1]) + widen(f[2])) * (1.0 / 3));
  }
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  nodes_.reserve(count);
  leaves_.reserve(count);
  facet_of_leaf_.reserve(count);
  if (count > 0) build(order, middles, {0, count, 0});
}

void TriangleTree::build(std::vector<std::uint32_t>& order, const std::vector<Vec3d>& middles,
                         const Range& range) {
  const auto [begin, end, depth] = range;
  const auto at = nodes_.size();
  nodes_.emplace_back();
  Box box;
  for (std::uint32_t i = begin; i < end; ++i) {
    for (const Vec3& corner : facets_[order[i]]) box.grow(widen(corner));
  }
  nodes_[at].min = narrow(box.min);
  nodes_[at].max = narrow(box.max);
  if (end - begin <= kFacetsPerLeaf) {
    // The parts below are sets; only here does their order show.
    std::sort(order.begin() + begin, order.begin() + end);
    nodes_[at].first = static_cast<std::uint32_t>(leaves_.size());
    nodes_[at].count = end - begin;
    for (std::uint32_t i = begin; i < end; ++i) {
      leaves_.push_back(facets_[order[i]]);
      facet_of_leaf_.push_back(order[i]);
    }
    return;
  }
  const std::uint32_t middle = part(order, middles, range);
  build(order, middles, {begin, middle, depth + 1});
  nodes_[at].first = static_cast<std::uint32_t>(nodes_.size());
  build(order, middles, {middle, end, depth + 1});
}

std::uint32_t TriangleTree::part(std::vector<std::uint32_t>& order,
                                 const std::vector<Vec3d>& middles, const Range& range) const {
  const auto first = order.begin() + range.begin;
  const auto last = order.begin() + range.end;
  Box of_middles;
  for (auto facet = first; facet != last; ++facet) of_middles.grow(middles[*facet]);
  Parting best;
  for (int axis = 0; axis < 3 && range.depth < kDeepest; ++axis) {
    if (!(component(of_middles.size(), axis) > 0)) continue;
    std::array<Bin, kBins> bins;
    for (auto facet = first; facet != last; ++facet) {
      Bin& bin = bins[binOf(middles[*facet], axis, of_middles)];
      for (const Vec3& corner : facets_[*facet]) bin.box.grow(widen(corner));
      ++bin.count;
    }
    const Parting parting = bestParting(bins, axis);
    if (parting.cost < best.cost) best = parting;
  }
  if (best.cost < HUGE_VAL) {
    const auto middle = std::partition(first, last, [&](std::uint32_t facet) {
      return binOf(middles[facet], best.axis, of_middles) < best.bin;
    });
    return static_cast<std::uint32_t>(middle - order.begin());
  }
  const int axis = longestAxis(of_middles.size());
  const std::uint32_t middle = range.begin + (range.end - range.begin) / 2;
  std::nth_element(first, order.begin() + middle, last, [&](std::uint32_t a, std::uint32_t b) {
    const double at_a = component(middles[a], axis);
    const double at_b = component(middles[b], axis);
    return at_a != at_b ? at_a < at_b : a < b;
  });
  return middle;
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
  // Boxes are compared in single precision: this much is more than their rounding.
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

}  // namespace galactic::bake::sphere_set
