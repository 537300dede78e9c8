#include "fit/stable_poses.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <span>

#include "fit/axes.h"
#include "fit/convex_hull.h"
#include "fit/rolling.h"
#include "fit/rotation.h"

namespace galactic::bake {
namespace {

using fit::ConvexHull;
using fit::HullShape;

/// How a body comes to rest, before it becomes a pose.
struct Resting {
  /// The direction in the object's frame that points down; unit length.
  Vec3d down;
  double likelihood = 0;
};

/// The vertices that triangles use, each once, or all vertices if the mesh has no triangles.
std::vector<Vec3> usedVertices(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return fit::uniquePoints(mesh.vertices);
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) used[corner] = true;
  }
  std::vector<Vec3> points;
  for (std::size_t at = 0; at < used.size(); ++at) {
    if (used[at]) points.push_back(mesh.vertices[at]);
  }
  return fit::uniquePoints(points);
}

/// A rod can lie on any side. Returns four of them, the first with the object as upright as
/// possible.
std::vector<Resting> restingsOfLine(const Vec3d& along) {
  const Vec3d down{0, -1, 0};
  const Vec3d across = down - along * dot(down, along);
  constexpr double kUpright = 1e-6;
  const Vec3d first = norm(across) > kUpright ? normalized(across) : fit::axesAround(along)[0];
  const Vec3d second = cross(along, first);
  return {{first, 0.25}, {second, 0.25}, {-first, 0.25}, {-second, 0.25}};
}

std::vector<Resting> restingsOfSolid(const ConvexHull& hull, std::span<const Vec3> points) {
  const std::vector<double> shares = fit::restingShares(hull);
  std::vector<Resting> restings;
  const double tolerance = fit::planeTolerance(hull);
  for (const fit::Facet& facet : fit::planarFacets(hull, tolerance)) {
    const double likelihood =
        std::accumulate(facet.begin(), facet.end(), 0.0,
                        [&](double sum, std::uint32_t face) { return sum + shares[face]; });
    if (likelihood > 0)
      restings.push_back({fit::facetNormal(hull, points, facet, tolerance), likelihood});
  }
  return restings;
}

std::vector<Resting> findRestings(const ConvexHull& hull, std::span<const Vec3> points) {
  switch (hull.shape) {
    case HullShape::kPoint:
      return {{{0, -1, 0}, 1}};
    case HullShape::kLine:
      return restingsOfLine(hull.frame[0]);
    case HullShape::kPlane:
      return {{hull.frame[2], 0.5}, {-hull.frame[2], 0.5}};
    case HullShape::kSolid:
      break;
  }
  return restingsOfSolid(hull, points);
}

/// Likelihoods are compared in steps of 1 / kLikelihoodSteps, because those of symmetric bodies are
/// only equal up to rounding.
constexpr double kLikelihoodSteps = 1e6;

/// Likeliest first; of equally likely ones, the more upright first.
void sortByLikelihood(std::vector<Resting>& restings) {
  std::stable_sort(restings.begin(), restings.end(), [](const Resting& a, const Resting& b) {
    const auto steps_a = std::llround(a.likelihood * kLikelihoodSteps);
    const auto steps_b = std::llround(b.likelihood * kLikelihoodSteps);
    return steps_a != steps_b ? steps_a > steps_b : a.down.y < b.down.y;
  });
}

/// Merges each resting into the likeliest one that differs by less than kSamePoseAngle.
std::vector<Resting> mergeSimilar(std::vector<Resting> restings) {
  const double same = std::cos(kSamePoseAngle);
  sortByLikelihood(restings);
  std::vector<Resting> merged;
  for (const Resting& resting : restings) {
    const auto known = std::find_if(merged.begin(), merged.end(), [&](const Resting& other) {
      return dot(other.down, resting.down) > same;
    });
    if (known == merged.end()) {
      merged.push_back(resting);
    } else {
      known->likelihood += resting.likelihood;
    }
  }
  sortByLikelihood(merged);
  return merged;
}

StablePose poseOf(const Resting& resting, std::span<const Vec3> points) {
  StablePose pose;
  pose.rotation = fit::shortestArc(resting.down, {0, -1, 0});
  pose.height = -std::numeric_limits<float>::infinity();
  for (const Vec3& point : points) {
    pose.height = std::max(pose.height, -rotate(pose.rotation, point).y);
  }
  pose.likelihood = static_cast<float>(resting.likelihood);
  return pose;
}

}  // namespace

std::vector<StablePose> findStablePoses(const TriangleMesh& mesh) {
  const std::vector<Vec3> points = usedVertices(mesh);
  if (points.empty()) return {{.rotation = {}, .height = 0, .likelihood = 1}};
  std::vector<Resting> restings = mergeSimilar(findRestings(fit::convexHull(points), points));
  if (restings.size() > kMaxStablePoses) restings.resize(kMaxStablePoses);
  std::vector<StablePose> poses;
  poses.reserve(restings.size());
  for (const Resting& resting : restings) {
    poses.push_back(poseOf(resting, points));
    // Rounding may make the later of two equally likely poses slightly likelier, so limit it to the
    // one before.
    if (poses.size() < 2) continue;
    poses.back().likelihood =
        std::min(poses.back().likelihood, std::prev(poses.end(), 2)->likelihood);
  }
  return poses;
}

}  // namespace galactic::bake
