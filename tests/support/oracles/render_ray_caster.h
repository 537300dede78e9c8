#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "galactic/batch_renderer.h"

namespace galactic::test {

/// Depths by rays in double precision against every triangle of a model that stands in the world's
/// frame, seen from both sides: slow, and nothing in common with a rasterizer.
class RenderRayCaster {
 public:
  RenderRayCaster(const RenderMeshes& meshes, std::uint32_t model_number) {
    const RenderModel& model = meshes.models[model_number];
    for (std::uint32_t c = 0; c < model.cluster_count; ++c) {
      const RenderCluster& cluster = meshes.clusters[model.first_cluster + c];
      for (std::uint32_t t = 0; t < cluster.triangle_count; ++t) {
        const std::size_t at = cluster.first_triangle + t;
        std::array<Point, 3> corners;
        for (std::size_t n = 0; n < 3; ++n) {
          corners[n] =
              pointOf(meshes, model, cluster, meshes.triangles[at / 8 * 24 + 8 * n + at % 8]);
        }
        triangles_.push_back(corners);
      }
    }
  }

  /// Depth along the camera's axis through a place in the image, pixels; 0 where nothing is.
  [[nodiscard]] double depthAt(const RenderCamera& camera, const RenderOptions& options, double x,
                               double y) const {
    const double focal =
        0.5 * options.height / std::tan(0.5 * static_cast<double>(camera.vertical_fov));
    const double right = (x - 0.5 * options.width) / focal;
    const double up = (0.5 * options.height - y) / focal;
    const RigidTransform& t = camera.world_from_camera;
    const auto direction = [&](float ahead, float upward, float rightward) {
      return static_cast<double>(ahead) + up * static_cast<double>(upward) +
             right * static_cast<double>(rightward);
    };
    const Point ray = {direction(t.x_axis.x, t.y_axis.x, t.z_axis.x),
                       direction(t.x_axis.y, t.y_axis.y, t.z_axis.y),
                       direction(t.x_axis.z, t.y_axis.z, t.z_axis.z)};
    const Point eye = {static_cast<double>(t.origin.x), static_cast<double>(t.origin.y),
                       static_cast<double>(t.origin.z)};
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::array<Point, 3>& corners : triangles_) {
      const double distance = hit(eye, ray, corners);
      if (distance >= static_cast<double>(options.near)) nearest = std::min(nearest, distance);
    }
    return std::isinf(nearest) ? 0 : nearest;
  }

  /// Depth at a pixel's center, and the range of depths within a pixel of it.
  struct Neighborhood {
    double middle, lowest, highest;
  };
  [[nodiscard]] Neighborhood around(const RenderCamera& camera, const RenderOptions& options,
                                    std::uint32_t x, std::uint32_t y) const {
    const double middle = depthAt(camera, options, x + 0.5, y + 0.5);
    Neighborhood range{middle, middle, middle};
    for (const double dx : {-1.0, -0.02, 0.02, 1.0}) {
      for (const double dy : {-1.0, -0.02, 0.02, 1.0}) {
        const double depth = depthAt(camera, options, x + 0.5 + dx, y + 0.5 + dy);
        range.lowest = std::min(range.lowest, depth);
        range.highest = std::max(range.highest, depth);
      }
    }
    return range;
  }

 private:
  using Point = std::array<double, 3>;

  static Point pointOf(const RenderMeshes& meshes, const RenderModel& model,
                       const RenderCluster& cluster, std::uint32_t number) {
    const std::size_t at = cluster.first_vertex + number;
    const auto step = static_cast<double>(model.step);
    const std::array<std::int32_t, 3> origin = {cluster.origin_x, cluster.origin_y,
                                                cluster.origin_z};
    Point point{};
    for (std::size_t n = 0; n < 3; ++n) {
      point[n] = step * (origin[n] + meshes.vertices[at / 8 * 40 + 8 * n + at % 8]);
    }
    return point;
  }

  static Point minus(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  static Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  static double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  /// Moeller and Trumbore: multiples of the ray to the triangle, negative for none.
  static double hit(const Point& eye, const Point& ray, const std::array<Point, 3>& corners) {
    const Point ab = minus(corners[1], corners[0]);
    const Point ac = minus(corners[2], corners[0]);
    const Point p = cross(ray, ac);
    const double determinant = dot(ab, p);
    if (determinant == 0) return -1;
    const Point from = minus(eye, corners[0]);
    const double u = dot(from, p) / determinant;
    const Point q = cross(from, ab);
    const double v = dot(ray, q) / determinant;
    if (u < 0 || v < 0 || u + v > 1) return -1;
    return dot(ac, q) / determinant;
  }

  std::vector<std::array<Point, 3>> triangles_;
};

}  // namespace galactic::test
