#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "common/vec3d.h"

namespace galactic::bake {

/// The corners of a triangle.
using Facet = std::array<Vec3, 3>;

inline constexpr std::uint32_t kNoFacet = std::numeric_limits<std::uint32_t>::max();

/// The point of a mesh nearest to a given point.
struct NearestPoint {
  /// Squared distance, square meters.
  double squared = 0;
  Vec3d point{};
  /// kNoFacet: nothing lies within the given limit.
  std::uint32_t facet = kNoFacet;
};

/// When a search for the nearest point may stop.
struct SearchLimits {
  /// Facets farther away than this do not count.
  double squared_limit = std::numeric_limits<double>::infinity();
  /// The search ends at the first point nearer than this, which need not be the nearest one.
  double squared_enough = 0;
  /// A facet that is likely to be near.
  std::uint32_t hint = kNoFacet;
};

/// A facet while a tree is built.
struct PartedFacet;

/// A bounding volume hierarchy over triangles for exact distances. Immutable, so threads may share
/// it.
class TriangleTree {
 public:
  explicit TriangleTree(std::vector<Facet> facets);

  [[nodiscard]] std::span<const Facet> facets() const { return facets_; }

  /// The nearest point of the triangles to `p`, in double precision.
  [[nodiscard]] NearestPoint nearest(const Vec3d& p, const SearchLimits& limits = {}) const;

 private:
  struct Node {
    Vec3 min;
    Vec3 max;
    /// First facet of a leaf, or index of the second child; the first child follows its parent.
    std::uint32_t first = 0;
    /// Number of facets of a leaf; 0 for an inner node.
    std::uint32_t count = 0;

    /// Squared distance of `p` to the box, in single precision.
    [[nodiscard]] float squaredDistance(const Vec3& p) const {
      const float x = std::max(std::max(min.x - p.x, p.x - max.x), 0.0F);
      const float y = std::max(std::max(min.y - p.y, p.y - max.y), 0.0F);
      const float z = std::max(std::max(min.z - p.z, p.z - max.z), 0.0F);
      return x * x + y * y + z * z;
    }
  };

  /// Appends the node for `facets`, `depth` levels below the root, and all nodes below it.
  void build(std::span<PartedFacet> facets, std::uint32_t depth);

  std::vector<Facet> facets_;
  std::vector<Node> nodes_;
  /// facets_ in the order of the leaves.
  std::vector<Facet> leaves_;
  /// Index into facets_ of each element of leaves_.
  std::vector<std::uint32_t> facet_of_leaf_;
};

/// The point of a triangle nearest to `p` (Ericson, Real-Time Collision Detection, 5.1.5).
[[nodiscard]] Vec3d nearestOnFacet(const Vec3d& p, const Facet& facet);

}  // namespace galactic::bake
