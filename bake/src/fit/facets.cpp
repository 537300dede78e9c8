#include "fit/facets.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <utility>

namespace galactic::bake::fit {
namespace {

/// Faces within this share of the hull's extent of the largest one's plane join it: the rounding of
/// their corners and of its own.
constexpr double kPlaneTolerance = 2 * kHullRounding;
/// A face steeper than this to the plane (cosine, 60 degrees) does not join it, however thin the
/// body is.
constexpr double kSteepest = 0.5;

class FacetBuilder {
 public:
  FacetBuilder(const ConvexHull& hull, std::span<const Vec3> points)
      : hull_(hull), points_(points), facet_of_face_(hull.faces.size(), kNone) {
    areas_.reserve(hull.faces.size());
    for (const auto& loop : hull.faces) {
      areas_.push_back(areaOf(loop, [&](std::uint32_t c) { return hull.corners[c].rounded; }));
    }
    for (const HullCorner& corner : hull.corners) {
      const Vec3d from = corner.rounded - hull.corners[0].rounded;
      tolerance_ = std::max(tolerance_, kPlaneTolerance * norm(from));
    }
    linkNeighbours();
  }

  std::vector<Facet> build() {
    std::vector<std::uint32_t> by_area(areas_.size());
    std::iota(by_area.begin(), by_area.end(), 0U);
    std::stable_sort(by_area.begin(), by_area.end(), [&](std::uint32_t a, std::uint32_t b) {
      return norm(areas_[a]) > norm(areas_[b]);
    });
    std::vector<Facet> facets;
    for (const std::uint32_t seed : by_area) {
      if (facet_of_face_[seed] != kNone) continue;
      Facet facet;
      collect(seed, static_cast<std::uint32_t>(facets.size()), facet);
      facet.normal = normalOf(facet);
      facets.push_back(std::move(facet));
    }
    return facets;
  }

 private:
  static constexpr std::uint32_t kNone = ~0U;

  /// Twice the area of a polygon, along its normal.
  template <class Place>
  static Vec3d areaOf(const std::vector<std::uint32_t>& loop, const Place& place) {
    Vec3d area;
    const Vec3d origin = place(loop[0]);
    for (std::size_t at = 2; at < loop.size(); ++at) {
      area = area + cross(place(loop[at - 1]) - origin, place(loop[at]) - origin);
    }
    return area;
  }

  void linkNeighbours() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> face_of_edge;
    const auto forEachEdge = [&](const auto& visit) {
      for (std::uint32_t face = 0; face < hull_.faces.size(); ++face) {
        const auto& loop = hull_.faces[face];
        for (std::size_t at = 0; at < loop.size(); ++at) {
          visit(face, loop[at], loop[at + 1 < loop.size() ? at + 1 : 0]);
        }
      }
    };
    forEachEdge([&](std::uint32_t face, std::uint32_t a, std::uint32_t b) {
      face_of_edge.emplace(std::pair(a, b), face);
    });
    neighbours_.resize(hull_.faces.size());
    forEachEdge([&](std::uint32_t face, std::uint32_t a, std::uint32_t b) {
      const auto beyond = face_of_edge.find({b, a});
      if (beyond != face_of_edge.end()) neighbours_[face].push_back(beyond->second);
    });
  }

  /// Grows a facet from its seed over faces that lie in the seed's plane.
  void collect(std::uint32_t seed, std::uint32_t facet_index, Facet& facet) {
    const Vec3d normal = normalized(areas_[seed]);
    const double height = dot(hull_.corners[hull_.faces[seed][0]].rounded, normal);
    const auto joins = [&](std::uint32_t face) {
      if (dot(normalized(areas_[face]), normal) < kSteepest) return false;
      return std::all_of(hull_.faces[face].begin(), hull_.faces[face].end(),
                         [&](std::uint32_t corner) {
                           return height - dot(hull_.corners[corner].rounded, normal) <= tolerance_;
                         });
    };
    facet.faces = {seed};
    facet_of_face_[seed] = facet_index;
    for (std::size_t at = 0; at < facet.faces.size(); ++at) {
      for (const std::uint32_t next : neighbours_[facet.faces[at]]) {
        if (facet_of_face_[next] != kNone || !joins(next)) continue;
        facet_of_face_[next] = facet_index;
        facet.faces.push_back(next);
      }
    }
  }

  /// From the sources of the corners, unless the hull's rounding decided which corners there are:
  /// then their plane may cut through the body, and that of the rounded corners is taken.
  [[nodiscard]] Vec3d normalOf(const Facet& facet) const {
    Vec3d exact;
    Vec3d rounded;
    for (const std::uint32_t face : facet.faces) {
      rounded = rounded + areas_[face];
      exact = exact + areaOf(hull_.faces[face], [&](std::uint32_t c) { return source(c); });
    }
    const Vec3d normal = normalized(exact);
    double plane = 0;
    double support = 0;
    bool first = true;
    for (const std::uint32_t face : facet.faces) {
      for (const std::uint32_t corner : hull_.faces[face]) {
        const double here = dot(source(corner), normal);
        plane = first ? here : std::min(plane, here);
        first = false;
      }
    }
    support = plane;
    for (std::uint32_t corner = 0; corner < hull_.corners.size(); ++corner) {
      support = std::max(support, dot(source(corner), normal));
    }
    return support - plane <= 2 * tolerance_ ? normal : normalized(rounded);
  }

  [[nodiscard]] Vec3d source(std::uint32_t corner) const {
    return widen(points_[hull_.corners[corner].source]);
  }

  const ConvexHull& hull_;
  std::span<const Vec3> points_;
  double tolerance_ = 0;
  std::vector<Vec3d> areas_;
  std::vector<std::vector<std::uint32_t>> neighbours_;
  std::vector<std::uint32_t> facet_of_face_;
};

}  // namespace

std::vector<Facet> planarFacets(const ConvexHull& hull, std::span<const Vec3> points) {
  return FacetBuilder(hull, points).build();
}

}  // namespace galactic::bake::fit
