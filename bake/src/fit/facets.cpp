#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "fit/convex_hull.h"

namespace galactic::bake::fit {
namespace {

/// The rounding of a face's corners and of the plane itself, as a share of the hull's extent.
constexpr double kPlaneTolerance = 2 * kHullRounding;
/// A face at a steeper angle to the plane than this (cosine, 60 degrees) does not join it, however
/// thin the body is.
constexpr double kSteepest = 0.5;

/// The outward normal of a face, scaled to twice its area. `place` gives the positions of its
/// corners.
template <class Place>
Vec3d areaOf(const std::vector<std::uint32_t>& face, const Place& place) {
  Vec3d area;
  const Vec3d origin = place(face[0]);
  for (std::size_t at = 2; at < face.size(); ++at) {
    area = area + cross(place(face[at - 1]) - origin, place(face[at]) - origin);
  }
  return area;
}

class FacetBuilder {
 public:
  FacetBuilder(const ConvexHull& hull, double tolerance)
      : hull_(hull), tolerance_(tolerance), facet_of_face_(hull.faces.size(), kNone) {
    areas_.reserve(hull.faces.size());
    for (const auto& face : hull.faces) {
      areas_.push_back(areaOf(face, [&](std::uint32_t c) { return hull.corners[c].rounded; }));
    }
    linkNeighbors();
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
      facets.push_back(collect(seed, static_cast<std::uint32_t>(facets.size())));
    }
    return facets;
  }

 private:
  static constexpr std::uint32_t kNone = ~0U;

  void linkNeighbors() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> face_of_edge;
    const auto for_each_edge = [&](const auto& visit) {
      for (std::uint32_t face = 0; face < hull_.faces.size(); ++face) {
        const auto& loop = hull_.faces[face];
        for (std::size_t at = 0; at < loop.size(); ++at) {
          visit(face, loop[at], loop[at + 1 < loop.size() ? at + 1 : 0]);
        }
      }
    };
    for_each_edge([&](std::uint32_t face, std::uint32_t a, std::uint32_t b) {
      face_of_edge.emplace(std::pair(a, b), face);
    });
    neighbors_.resize(hull_.faces.size());
    for_each_edge([&](std::uint32_t face, std::uint32_t a, std::uint32_t b) {
      const auto beyond = face_of_edge.find({b, a});
      if (beyond != face_of_edge.end()) neighbors_[face].push_back(beyond->second);
    });
  }

  /// Grows a facet from its seed over faces that lie in the seed's plane.
  Facet collect(std::uint32_t seed, std::uint32_t facet_index) {
    const Vec3d normal = normalized(areas_[seed]);
    const double height = dot(hull_.corners[hull_.faces[seed][0]].rounded, normal);
    const auto joins = [&](std::uint32_t face) {
      if (dot(normalized(areas_[face]), normal) < kSteepest) return false;
      return std::all_of(hull_.faces[face].begin(), hull_.faces[face].end(),
                         [&](std::uint32_t corner) {
                           return height - dot(hull_.corners[corner].rounded, normal) <= tolerance_;
                         });
    };
    Facet facet{seed};
    facet_of_face_[seed] = facet_index;
    for (std::size_t at = 0; at < facet.size(); ++at) {
      for (const std::uint32_t next : neighbors_[facet[at]]) {
        if (facet_of_face_[next] != kNone || !joins(next)) continue;
        facet_of_face_[next] = facet_index;
        facet.push_back(next);
      }
    }
    return facet;
  }

  const ConvexHull& hull_;
  double tolerance_ = 0;
  std::vector<Vec3d> areas_;
  std::vector<std::vector<std::uint32_t>> neighbors_;
  std::vector<std::uint32_t> facet_of_face_;
};

}  // namespace

double planeTolerance(const ConvexHull& hull) {
  double extent = 0;
  for (const HullCorner& corner : hull.corners) {
    extent = std::max(extent, norm(corner.rounded - hull.corners[0].rounded));
  }
  return kPlaneTolerance * extent;
}

std::vector<Facet> planarFacets(const ConvexHull& hull, double tolerance) {
  return FacetBuilder(hull, tolerance).build();
}

Vec3d facetNormal(const ConvexHull& hull, std::span<const Vec3> points, const Facet& facet,
                  double tolerance) {
  const auto source = [&](std::uint32_t corner) {
    return widen(points[hull.corners[corner].source]);
  };
  Vec3d exact;
  Vec3d rounded;
  for (const std::uint32_t face : facet) {
    exact = exact + areaOf(hull.faces[face], source);
    rounded = rounded +
              areaOf(hull.faces[face], [&](std::uint32_t c) { return hull.corners[c].rounded; });
  }
  const Vec3d normal = normalized(exact);
  // The lowest corner of the facet, and the highest of the body.
  double plane = std::numeric_limits<double>::infinity();
  double support = -plane;
  for (const std::uint32_t face : facet) {
    for (const std::uint32_t corner : hull.faces[face]) {
      plane = std::min(plane, dot(source(corner), normal));
    }
  }
  for (std::uint32_t corner = 0; corner < hull.corners.size(); ++corner) {
    support = std::max(support, dot(source(corner), normal));
  }
  return support - plane <= 2 * tolerance ? normal : normalized(rounded);
}

}  // namespace galactic::bake::fit
