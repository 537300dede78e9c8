#include "fit/rolling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>

namespace galactic::bake::fit {

Vec3d centerOfMass(const ConvexHull& hull) {
  const Vec3d origin = hull.corners[0].rounded;
  Vec3d moment;
  double volume = 0;
  for (const std::vector<std::uint32_t>& face : hull.faces) {
    const Vec3d a = hull.corners[face[0]].rounded - origin;
    for (std::size_t at = 2; at < face.size(); ++at) {
      const Vec3d b = hull.corners[face[at - 1]].rounded - origin;
      const Vec3d c = hull.corners[face[at]].rounded - origin;
      const double part = dot(a, cross(b, c));
      volume += part;
      moment = moment + (a + b + c) * part;
    }
  }
  return volume > 0 ? origin + moment * (1 / (4 * volume)) : origin;
}

namespace {

/// A face seen from the center of mass, which is the origin.
struct Face {
  Vec3d normal;
  /// Height of the center of mass above the face's plane.
  double height = 0;
  double solid_angle = 0;
};

/// The solid angle of a triangle (van Oosterom and Strackee 1983).
double solidAngle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double la = norm(a);
  const double lb = norm(b);
  const double lc = norm(c);
  const double opening = la * lb * lc + dot(a, b) * lc + dot(a, c) * lb + dot(b, c) * la;
  return 2 * std::atan2(dot(a, cross(b, c)), opening);
}

/// An edge of a face, with its corners in order.
struct DirectedEdge {
  std::pair<std::uint32_t, std::uint32_t> corners;
  std::uint32_t face = 0;
};

class RollingBody {
 public:
  explicit RollingBody(const ConvexHull& hull) : hull_(hull) {
    const Vec3d center = centerOfMass(hull);
    corners_.reserve(hull.corners.size());
    for (const HullCorner& corner : hull.corners) corners_.push_back(corner.rounded - center);
    faces_.reserve(hull.faces.size());
    for (const auto& loop : hull.faces) faces_.push_back(measure(loop));
    listEdges();
  }

  [[nodiscard]] const Face& face(std::size_t index) const { return faces_[index]; }

  /// The face that the body rolls onto from face `index`; `index` itself if it rests there.
  [[nodiscard]] std::uint32_t next(std::uint32_t index) const {
    const Face& face = faces_[index];
    const Vec3d foot = face.normal * face.height;
    const auto& loop = hull_.faces[index];
    std::uint32_t best = index;
    Crossing best_crossing;
    for (std::size_t at = 0; at < loop.size(); ++at) {
      const std::uint32_t from = loop[at];
      const std::uint32_t to = loop[at + 1 < loop.size() ? at + 1 : 0];
      const auto crossing = crossEdge(foot, face.normal, corners_[from], corners_[to]);
      if (!crossing) continue;
      const std::uint32_t beyond = faceWith({to, from}, index);
      if (faces_[beyond].height >= face.height) continue;
      if (best != index && !(*crossing < best_crossing)) continue;
      best = beyond;
      best_crossing = *crossing;
    }
    return best;
  }

 private:
  /// The position of a foot relative to an edge that it is outside of.
  struct Crossing {
    double distance = 0;
    /// Distance beyond the edge's line. At a corner, it decides which of two edges the body rolls
    /// over.
    double beyond_line = 0;

    bool operator<(const Crossing& other) const {
      const double same = 1e-9 * (distance + other.distance);
      if (std::abs(distance - other.distance) > same) return distance < other.distance;
      return beyond_line > other.beyond_line;
    }
  };

  /// None if the foot is on the inner side of the edge.
  static std::optional<Crossing> crossEdge(const Vec3d& foot, const Vec3d& normal, const Vec3d& a,
                                           const Vec3d& b) {
    const Vec3d along = b - a;
    const Vec3d from = foot - a;
    const double beyond = dot(from, normalized(cross(along, normal)));
    if (beyond <= 0) return {};
    const double share = std::clamp(dot(from, along) / dot(along, along), 0.0, 1.0);
    return Crossing{norm(from - along * share), beyond};
  }

  [[nodiscard]] Face measure(const std::vector<std::uint32_t>& loop) const {
    Face face;
    Vec3d area;
    const Vec3d& first = corners_[loop[0]];
    for (std::size_t at = 2; at < loop.size(); ++at) {
      const Vec3d& second = corners_[loop[at - 1]];
      const Vec3d& third = corners_[loop[at]];
      area = area + cross(second - first, third - first);
      face.solid_angle += solidAngle(first, second, third);
    }
    face.normal = normalized(area);
    for (const std::uint32_t corner : loop) face.height += dot(corners_[corner], face.normal);
    face.height /= static_cast<double>(loop.size());
    return face;
  }

  void listEdges() {
    for (std::uint32_t index = 0; index < hull_.faces.size(); ++index) {
      const auto& loop = hull_.faces[index];
      for (std::size_t at = 0; at < loop.size(); ++at) {
        edges_.push_back({{loop[at], loop[at + 1 < loop.size() ? at + 1 : 0]}, index});
      }
    }
    std::sort(edges_.begin(), edges_.end(), [](const DirectedEdge& a, const DirectedEdge& b) {
      return a.corners < b.corners || (a.corners == b.corners && a.face < b.face);
    });
  }

  /// The face with a directed edge; `otherwise` if the hull has no such face.
  [[nodiscard]] std::uint32_t faceWith(std::pair<std::uint32_t, std::uint32_t> corners,
                                       std::uint32_t otherwise) const {
    const auto found = std::lower_bound(
        edges_.begin(), edges_.end(), corners,
        [](const DirectedEdge& edge, const auto& wanted) { return edge.corners < wanted; });
    return found != edges_.end() && found->corners == corners ? found->face : otherwise;
  }

  const ConvexHull& hull_;
  std::vector<Vec3d> corners_;
  std::vector<Face> faces_;
  std::vector<DirectedEdge> edges_;
};

}  // namespace

std::vector<double> restingShares(const ConvexHull& hull) {
  const RollingBody body(hull);
  std::vector<double> shares(hull.faces.size());
  double total = 0;
  for (std::size_t face = 0; face < shares.size(); ++face) {
    shares[face] = std::max(0.0, body.face(face).solid_angle);
    total += shares[face];
  }
  std::vector<std::uint32_t> from_highest(shares.size());
  std::iota(from_highest.begin(), from_highest.end(), 0U);
  std::stable_sort(from_highest.begin(), from_highest.end(), [&](std::uint32_t a, std::uint32_t b) {
    return body.face(a).height > body.face(b).height;
  });
  for (const std::uint32_t face : from_highest) {
    const std::uint32_t next = body.next(face);
    if (next == face) continue;
    shares[next] += std::exchange(shares[face], 0.0);
  }
  for (double& share : shares) share /= total;
  return shares;
}

}  // namespace galactic::bake::fit
