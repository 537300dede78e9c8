#include "ambient/ambient_occlusion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ambient/ray_pattern.h"
#include "ambient/vertex_fans.h"
#include "engines/triangle_rays.h"
#include "galactic/bake/parallel_for.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

constexpr unsigned kMostRays = 65536;
/// Rays start this far off their triangle, which is more than the rounding of float coordinates in
/// a home. Meters.
constexpr double kLift = 1e-4;
/// Number of vertices that a thread takes at a time.
constexpr std::size_t kChunk = 256;

Result<void> checkOptions(const AmbientOcclusionOptions& options) {
  if (options.rays < 1 || options.rays > kMostRays) {
    return fail(ErrorCode::kInvalidInput, "ambient occlusion: rays",
                fmt::format("{} rays a vertex; give 1 to {}", options.rays, kMostRays));
  }
  if (!(options.largest_distance > 0) || !std::isfinite(options.largest_distance)) {
    return fail(ErrorCode::kInvalidInput, "ambient occlusion: largest distance",
                fmt::format("the distance {} is not valid; give a positive number of meters",
                            options.largest_distance));
  }
  if (!(options.least_distance >= 0) || !(options.least_distance < options.largest_distance)) {
    return fail(ErrorCode::kInvalidInput, "ambient occlusion: least distance",
                fmt::format("{} is not between 0 and the largest distance, {}",
                            options.least_distance, options.largest_distance));
  }
  if (!(options.dim >= 0 && options.dim <= 1)) {
    return fail(ErrorCode::kInvalidInput, "ambient occlusion: dim",
                fmt::format("the light factor {} is out of range; give 0 to 1", options.dim));
  }
  return {};
}

Result<TriangleRays> allOccluders(std::span<const OccludingMesh> meshes, unsigned threads) {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  for (const OccludingMesh& mesh : meshes) {
    vertices += mesh.positions.size();
    triangles += mesh.triangles.size();
  }
  std::vector<Vec3> all_positions;
  std::vector<Triangle> all_triangles;
  all_positions.reserve(vertices + 1);
  all_triangles.reserve(triangles);
  for (const OccludingMesh& mesh : meshes) {
    const auto first = static_cast<std::uint32_t>(all_positions.size());
    all_positions.insert(all_positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const Triangle& t : mesh.triangles) {
      all_triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  auto occluders = TriangleRays::build(std::move(all_positions), std::move(all_triangles), threads);
  if (!occluders) {
    return fail(ErrorCode::kUnsupported, "`lighting`",
                "could not build its scene, for lack of memory; bake with `lighting` none");
  }
  return *std::move(occluders);
}

using Vector = std::array<double, 3>;

/// Two axes that form a right-handed frame with the unit vector `n` (Duff et al., "Building an
/// Orthonormal Basis, Revisited", 2017).
std::array<Vector, 2> tangents(const Vector& n) {
  const double sign = std::copysign(1.0, n[2]);
  const double a = -1 / (sign + n[2]);
  const double b = n[0] * n[1] * a;
  return {Vector{1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]},
          Vector{b, sign + n[1] * n[1] * a, -n[1]}};
}

/// Makes the rays that start on the triangles around the vertices of one mesh.
class RayMaker {
 public:
  RayMaker(const OccludingMesh& mesh, std::span<const PatternRay> pattern,
           const AmbientOcclusionOptions& options)
      : mesh_(mesh), pattern_(pattern), options_(options), fans_(mesh.positions, mesh.triangles) {}

  /// Makes the rays of a vertex, which start at the fronts (`side` 1) or backs (-1) of its
  /// triangles; none if the triangles have no area.
  void make(std::size_t vertex, double side, std::vector<Ray>& rays) const {
    rays.clear();
    const std::span<const FanTriangle> fan = fans_.of(vertex);
    double total = 0;
    for (const FanTriangle& entry : fan) total += fans_.area(entry.triangle);
    if (!(total > 0)) return;
    for (const PatternRay& ray : pattern_) {
      std::size_t chosen = 0;
      double before = 0;
      while (chosen + 1 < fan.size() &&
             before + fans_.area(fan[chosen].triangle) <= ray.triangle * total) {
        before += fans_.area(fan[chosen++].triangle);
      }
      rays.push_back(fromTriangle(fan[chosen], ray, side));
    }
  }

 private:
  [[nodiscard]] Ray fromTriangle(const FanTriangle& from, const PatternRay& ray,
                                 double side) const {
    const Vector& normal = fans_.normal(from.triangle);
    const auto [first, second] = tangents(normal);
    const Triangle& triangle = mesh_.triangles[from.triangle];
    const std::array<double, 3> weights{ray.own, ray.next, 1 - ray.own - ray.next};
    Vector origin{};
    Vector direction{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      origin[axis] = side * kLift * normal[axis];
      direction[axis] = ray.direction[0] * first[axis] + ray.direction[1] * second[axis] +
                        ray.direction[2] * side * normal[axis];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = mesh_.positions[triangle[(from.corner + k) % 3]];
      origin[0] += weights[k] * static_cast<double>(p.x);
      origin[1] += weights[k] * static_cast<double>(p.y);
      origin[2] += weights[k] * static_cast<double>(p.z);
    }
    const auto rounded = [](const Vector& v) {
      return Vec3{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
    };
    return {.origin = rounded(origin),
            .direction = rounded(direction),
            .nearest = options_.least_distance,
            .farthest = options_.largest_distance};
  }

  const OccludingMesh& mesh_;
  std::span<const PatternRay> pattern_;
  const AmbientOcclusionOptions& options_;
  VertexFans fans_;
};

/// The share of the rays that hit nothing; 1 without rays.
float openPart(const TriangleRays& occluders, std::span<const Ray> rays) {
  if (rays.empty()) return 1;
  const auto open = std::count_if(rays.begin(), rays.end(),
                                  [&](const Ray& ray) { return occluders.isOpen(ray); });
  return static_cast<float>(static_cast<double>(open) / static_cast<double>(rays.size()));
}

}  // namespace

Result<std::vector<std::vector<Openness>>> ambientOcclusion(std::span<const OccludingMesh> meshes,
                                                            const AmbientOcclusionOptions& options,
                                                            unsigned threads) {
  RETURN_IF_ERROR(checkOptions(options));
  ASSIGN_OR_RETURN(const auto occluders, allOccluders(meshes, threads));
  const std::vector<PatternRay> pattern = rayPattern(options.rays);

  std::vector<std::vector<Openness>> openness(meshes.size());
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    if (meshes[m].lit == LitSides::kNone) continue;
    const RayMaker maker(meshes[m], pattern, options);
    const std::size_t vertices = meshes[m].positions.size();
    openness[m].resize(vertices);
    parallelFor(threads, (vertices + kChunk - 1) / kChunk, [&](std::size_t chunk) {
      std::vector<Ray> rays;
      rays.reserve(pattern.size());
      const std::size_t end = std::min(vertices, (chunk + 1) * kChunk);
      for (std::size_t v = chunk * kChunk; v < end; ++v) {
        Openness& of_vertex = openness[m][v];
        maker.make(v, 1, rays);
        of_vertex.front = openPart(occluders, rays);
        if (meshes[m].lit != LitSides::kBoth || of_vertex.front >= options.dim) continue;
        maker.make(v, -1, rays);
        of_vertex.back = openPart(occluders, rays);
      }
    });
  }
  return openness;
}

}  // namespace galactic::bake
