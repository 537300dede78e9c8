#include "dynamics/bullet/shapes.h"

#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace galactic::dynamics {
namespace {

/// Volume, center and second moments of the tetrahedra between the origin and the triangles of a
/// hull (Eberly, Polyhedral Mass Properties, 2002).
class SolidSum {
 public:
  using Point = std::array<double, 3>;

  void add(const Point& a, const Point& b, const Point& c) {
    const double volume = (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                           a[2] * (b[0] * c[1] - b[1] * c[0])) /
                          6;
    volume_ += volume;
    for (std::size_t i = 0; i < 3; ++i) {
      const double sum = a[i] + b[i] + c[i];
      first_[i] += volume * sum / 4;
      for (std::size_t k = i; k < 3; ++k) {
        const double products = a[i] * a[k] + b[i] * b[k] + c[i] * c[k];
        second_[i][k] += volume / 20 * (sum * (a[k] + b[k] + c[k]) + products);
      }
    }
  }

  /// The inertia of a mass that is spread evenly.
  [[nodiscard]] Inertia inertia(double mass) const {
    Inertia result{.mass = mass, .center = {}, .moments = {}};
    const double density = mass / volume_;
    std::array<std::array<double, 3>, 3> about{};
    for (std::size_t i = 0; i < 3; ++i) result.center[i] = first_[i] / volume_;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = i; k < 3; ++k) {
        about[i][k] = density * second_[i][k] - mass * result.center[i] * result.center[k];
      }
    }
    result.moments = {about[1][1] + about[2][2],
                      about[0][0] + about[2][2],
                      about[0][0] + about[1][1],
                      -about[0][1],
                      -about[0][2],
                      -about[1][2]};
    return result;
  }
  [[nodiscard]] double volume() const { return volume_; }

 private:
  double volume_ = 0;
  std::array<double, 3> first_{};
  std::array<std::array<double, 3>, 3> second_{};
};

btConvexHullComputer hullOf(const HullPoints& points) {
  btConvexHullComputer hull;
  hull.compute(&points.front().x, sizeof(Vec3), static_cast<int>(points.size()), 0, 0);
  return hull;
}

void addSolid(const HullPoints& points, SolidSum& sum) {
  const btConvexHullComputer hull = hullOf(points);
  const auto corner = [&](int n) {
    const Vec3 at = fromBullet(hull.vertices[n]);
    return SolidSum::Point{static_cast<double>(at.x), static_cast<double>(at.y),
                           static_cast<double>(at.z)};
  };
  for (int f = 0; f < hull.faces.size(); ++f) {
    const btConvexHullComputer::Edge* first = &hull.edges[hull.faces[f]];
    for (const auto* edge = first->getNextEdgeOfFace(); edge != first;
         edge = edge->getNextEdgeOfFace()) {
      sum.add(corner(first->getSourceVertex()), corner(edge->getSourceVertex()),
              corner(edge->getTargetVertex()));
    }
  }
}

/// The inertia of the box around the points, for points that enclose no volume.
Inertia inertiaOfBox(const ObjectSource& source) {
  Vec3 least = source.hulls.front().front();
  Vec3 most = least;
  for (const HullPoints& points : source.hulls) {
    for (const Vec3& p : points) {
      least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
      most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
    }
  }
  constexpr float kThinnest = 1e-3F;
  const auto x = static_cast<double>(std::max(most.x - least.x, kThinnest));
  const auto y = static_cast<double>(std::max(most.y - least.y, kThinnest));
  const auto z = static_cast<double>(std::max(most.z - least.z, kThinnest));
  const Vec3 center = (least + most) * 0.5F;
  const double twelfth = source.mass / 12;
  return {.mass = source.mass,
          .center = {static_cast<double>(center.x), static_cast<double>(center.y),
                     static_cast<double>(center.z)},
          .moments = {twelfth * (y * y + z * z), twelfth * (x * x + z * z),
                      twelfth * (x * x + y * y), 0, 0, 0}};
}

Inertia inertiaOf(const ObjectSource& source) {
  constexpr double kNoVolume = 1e-9;
  SolidSum sum;
  for (const HullPoints& points : source.hulls) addSolid(points, sum);
  return sum.volume() > kNoVolume ? sum.inertia(source.mass) : inertiaOfBox(source);
}

/// A hull may lose this much of its extent in any direction, meters, as the cost of contacts is
/// proportional to its corners.
constexpr btScalar kRounding = 5e-4F;
/// The number of directions in which that is checked, spread evenly (on a golden spiral).
constexpr int kDirections = 1000;

btVector3 directionOf(int n) {
  constexpr double kGoldenTurn = std::numbers::pi * (1 + 2.23606797749979);
  const double z = 1 - (2 * n + 1.0) / kDirections;
  const double around = std::sqrt(1 - z * z);
  const double angle = kGoldenTurn * (n + 0.5);
  return {static_cast<btScalar>(around * std::cos(angle)),
          static_cast<btScalar>(around * std::sin(angle)), static_cast<btScalar>(z)};
}

/// Corners of `hull` whose own hull has the same extent in all of the directions, to within
/// kRounding. Adds the corner that is missed most, one by one. In the order of the hull's corners.
std::vector<int> cornersThatMatter(const btConvexHullComputer& hull) {
  struct Direction {
    btVector3 way;
    int corner = 0;
    btScalar far = 0;
    btScalar reached = -BT_LARGE_FLOAT;
  };
  std::vector<Direction> directions(kDirections);
  for (int n = 0; n < kDirections; ++n) {
    Direction& direction = directions[static_cast<std::size_t>(n)];
    direction.way = directionOf(n);
    direction.corner = static_cast<int>(
        direction.way.maxDot(&hull.vertices[0], hull.vertices.size(), direction.far));
  }
  std::vector<int> kept;
  const auto missed = [](const Direction& a, const Direction& b) {
    return a.far - a.reached < b.far - b.reached;
  };
  // Each round adds a corner. The limit is needed where sums of huge coordinates overflow: then the
  // missed distance is NaN and never small.
  while (kept.size() < static_cast<std::size_t>(hull.vertices.size())) {
    const Direction most = *std::ranges::max_element(directions, missed);
    if (most.far - most.reached <= kRounding) break;
    kept.push_back(most.corner);
    for (Direction& direction : directions) {
      direction.reached =
          std::max(direction.reached, direction.way.dot(hull.vertices[most.corner]));
    }
  }
  std::ranges::sort(kept);
  return kept;
}

}  // namespace

std::unique_ptr<btConvexHullShape> makeHull(const HullPoints& points) {
  const btConvexHullComputer corners = hullOf(points);
  auto hull = std::make_unique<btConvexHullShape>();
  for (const int n : cornersThatMatter(corners)) hull->addPoint(corners.vertices[n], false);
  hull->recalcLocalAabb();
  hull->setMargin(0);
  // Finds contacts of whole faces at once, not one corner per step.
  hull->initializePolyhedralFeatures();
  return hull;
}

PrincipalInertia principalInertia(const Inertia& inertia) {
  const auto value = [&](std::size_t n) { return static_cast<btScalar>(inertia.moments[n]); };
  btMatrix3x3 moments(value(0), value(3), value(4), value(3), value(1), value(5), value(4),
                      value(5), value(2));
  btMatrix3x3 axes;
  constexpr btScalar kShareOfLargest = 1e-6F;
  constexpr int kMostSweeps = 30;
  moments.diagonalize(axes, kShareOfLargest, kMostSweeps);
  const auto& center = inertia.center;
  return {.mass = static_cast<btScalar>(inertia.mass),
          .moments = {moments[0][0], moments[1][1], moments[2][2]},
          .body_from_inertia = btTransform(
              axes, btVector3(static_cast<btScalar>(center[0]), static_cast<btScalar>(center[1]),
                              static_cast<btScalar>(center[2])))};
}

ObjectShape::ObjectShape(const ObjectSource& source)
    : friction_(source.friction),
      compound_(std::make_unique<btCompoundShape>()),
      inertia_(principalInertia(inertiaOf(source))) {
  const btTransform inertia_from_object = inertia_.body_from_inertia.inverse();
  for (const HullPoints& points : source.hulls) {
    hulls_.push_back(makeHull(points));
    compound_->addChildShape(inertia_from_object, hulls_.back().get());
  }
  compound_->setMargin(0);
}

RobotShape::RobotShape(const RobotParts& parts) {
  for (const LinkPart& link : parts.links) {
    auto& hulls = hulls_of_link_.emplace_back();
    for (const HullPoints& points : link.hulls) hulls.push_back(makeHull(points));
  }
}

std::unique_ptr<btCompoundShape> RobotShape::compound(const RobotBody& body,
                                                      const btTransform& body_from_frame) const {
  auto compound = std::make_unique<btCompoundShape>();
  const btTransform frame_from_body = body_from_frame.inverse();
  for (const BodyLink& link : body.links) {
    for (const auto& hull : hulls_of_link_[link.link]) {
      compound->addChildShape(frame_from_body * toBullet(link.body_from_link), hull.get());
    }
  }
  compound->setMargin(0);
  return compound;
}

std::vector<std::uint32_t> RobotShape::linksOfChildren(const RobotBody& body) const {
  std::vector<std::uint32_t> links;
  for (const BodyLink& link : body.links) {
    links.insert(links.end(), hulls_of_link_[link.link].size(), link.link);
  }
  return links;
}

std::shared_ptr<const SceneShape> makeSceneShape(const bake::TriangleMesh& mesh) {
  return std::make_shared<const SceneShape>(mesh);
}
std::shared_ptr<const ObjectShape> makeObjectShape(const ObjectSource& source) {
  return std::make_shared<const ObjectShape>(source);
}
std::shared_ptr<const RobotShape> makeRobotShape(const RobotParts& parts) {
  return std::make_shared<const RobotShape>(parts);
}

}  // namespace galactic::dynamics
