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

/// The point of a mesh that is nearest to some other point.
struct NearestPoint {
  /// Square of the distance, square meters.
  double squared = 0;
  Vec3d point{};
  /// kNoFacet: nothing within the limit that was asked for.
  std::uint32_t facet = kNoFacet;
};

/// How far a search for the nearest point has to go.
struct SearchLimits {
  /// Nothing further than this counts.
  double squared_limit = std::numeric_limits<double>::infinity();
  /// Anything nearer than this ends the search: the answer need not be the nearest then.
  double squared_enough = 0;
  /// A facet that is likely near.
  std::uint32_t hint = kNoFacet;
};

/// A facet while a tree is built.
struct PartedFacet;

/// A bounding volume hierarchy over triangles for exact distances. Immutable, so safe to share
/// between threads.
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
    /// Facets of a leaf; 0: an inner node.
    std::uint32_t count = 0;

    /// Of `p` to the box, in single precision.
    [[nodiscard]] float squaredDistance(const Vec3& p) const {
      const float x = std::max(std::max(min.x - p.x, p.x - max.x), 0.0F);
      const float y = std::max(std::max(min.y - p.y, p.y - max.y), 0.0F);
      const float z = std::max(std::max(min.z - p.z, p.z - max.z), 0.0F);
      return x * x + y * y + z * z;
    }
  };

  /// Appends the node of some facets, `depth` nodes below the root, and all nodes below it.
  void build(std::span<PartedFacet> facets, std::uint32_t depth);

  std::vector<Facet> facets_;
  std::vector<Node> nodes_;
  /// facets_ in the order of the leaves.
  std::vector<Facet> leaves_;
  /// Index into facets_ of each of leaves_.
  std::vector<std::uint32_t> facet_of_leaf_;
};

/// The point of a triangle nearest to `p` (Ericson, Real-Time Collision Detection, 5.1.5).
[[nodiscard]] Vec3d nearestOnFacet(const Vec3d& p, const Facet& facet);

}  // namespace galactic::bake
