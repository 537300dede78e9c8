// Ambient occlusion against slow random rays in double precision, all triangles tried for each.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "occlusion_meshes.h"

namespace galactic::test::ambient_oracle_test {
namespace {

using bake::OccludingMesh;
using bake::Triangle;
using Point = std::array<double, 3>;

Point toPoint(const Vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Whether the triangle lies across the segment of unit direction (Moeller and Trumbore).
bool meets(const std::array<Point, 3>& t, const Point& origin, const Point& direction,
           double distance) {
  const Point e1 = t[1] - t[0];
  const Point e2 = t[2] - t[0];
  const Point p = cross(direction, e2);
  const double det = dot(e1, p);
  if (det == 0) return false;
  const Point s = origin - t[0];
  const double u = dot(s, p) / det;
  const Point q = cross(s, e1);
  const double v = dot(direction, q) / det;
  const double at = dot(e2, q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && at > 0 && at < distance;
}

/// Random rays from the triangles that use `vertex`, weighted with its barycentric coordinate.
class RandomRays {
 public:
  RandomRays(const std::vector<TestMesh>& meshes, std::uint32_t seed) : random_(seed) {
    for (const TestMesh& mesh : meshes) {
      for (const Triangle& t : mesh.triangles) all_.push_back(cornersOf(mesh, t));
    }
  }

  double openness(const TestMesh& mesh, std::uint32_t vertex, double distance) {
    std::vector<std::array<Point, 3>> fan;
    std::vector<double> areas;
    for (Triangle t : mesh.triangles) {
      for (int turn = 0; turn < 3; ++turn, std::rotate(t.begin(), t.begin() + 1, t.end())) {
        if (t[0] != vertex) continue;
        fan.push_back(cornersOf(mesh, t));
        const Point n = cross(fan.back()[1] - fan.back()[0], fan.back()[2] - fan.back()[0]);
        areas.push_back(std::sqrt(dot(n, n)));
        break;
      }
    }
    std::discrete_distribution<std::size_t> choose(areas.begin(), areas.end());
    constexpr int kRays = 10000;
    int open = 0;
    for (int i = 0; i < kRays; ++i) open += isOpen(fan[choose(random_)], distance) ? 1 : 0;
    return static_cast<double>(open) / kRays;
  }

 private:
  static std::array<Point, 3> cornersOf(const TestMesh& mesh, const Triangle& t) {
    return {toPoint(mesh.positions[t[0]]), toPoint(mesh.positions[t[1]]),
            toPoint(mesh.positions[t[2]])};
  }

  bool isOpen(const std::array<Point, 3>& from, double distance) {
    std::uniform_real_distribution<double> unit(0, 1);
    double u = 0;
    double v = 0;
    // Uniform in the triangle, then kept with the probability of the weight.
    do {
      u = unit(random_);
      v = unit(random_);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
    } while (unit(random_) > 1 - u - v);
    Point n = cross(from[1] - from[0], from[2] - from[0]);
    const double length = std::sqrt(dot(n, n));
    for (double& c : n) c /= length;
    // Uniform on the sphere plus the normal is cosine-weighted.
    const double z = 2 * unit(random_) - 1;
    const double angle = 2 * std::numbers::pi * unit(random_);
    const double r = std::sqrt(1 - z * z);
    Point direction{r * std::cos(angle) + n[0], r * std::sin(angle) + n[1], z + n[2]};
    const double norm = std::sqrt(dot(direction, direction));
    Point origin{};
    for (std::size_t c = 0; c < 3; ++c) {
      direction[c] /= norm;
      constexpr double kLift = 1e-4;
      origin[c] = (1 - u - v) * from[0][c] + u * from[1][c] + v * from[2][c] + kLift * n[c];
    }
    return std::none_of(all_.begin(), all_.end(), [&](const auto& triangle) {
      return meets(triangle, origin, direction, distance);
    });
  }

  std::vector<std::array<Point, 3>> all_;
  std::mt19937 random_;
};

TEST(AmbientOracle, AgreesInARoomOfRandomBoxes) {
  constexpr std::uint32_t kSeed = 20240717;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<TestMesh> meshes{sheet({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 3),
                               box({1, 1.2F, 1}, true)};
  for (int n = 0; n < 10; ++n) {
    TestMesh body = box(
        {0.05F + 0.3F * unit(random), 0.05F + 0.3F * unit(random), 0.05F + 0.3F * unit(random)});
    const Vec3 at{1.6F * unit(random) - 0.8F, unit(random), 1.6F * unit(random) - 0.8F};
    for (Vec3& p : body.positions) p = p + at;
    meshes.push_back(body);
  }
  std::vector<OccludingMesh> placed;
  for (const TestMesh& mesh : meshes) placed.push_back(mesh.placed());
  constexpr float kDistance = 0.8F;
  const auto openness = opennessOf(placed, {.rays = 2048, .largest_distance = kDistance});
  RandomRays oracle(meshes, kSeed);
  std::size_t dark = 0;
  std::size_t cases = 0;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    for (std::uint32_t v = 0; v < meshes[m].positions.size(); ++v) {
      const double wanted = oracle.openness(meshes[m], v, static_cast<double>(kDistance));
      // Four standard deviations of 10,000 random rays, and as much for the pattern.
      constexpr double kNoise = 0.028;
      EXPECT_NEAR(static_cast<double>(openness[m][v].front), wanted, kNoise) << m << " " << v;
      dark += wanted < 0.5 ? 1U : 0U;
      ++cases;
    }
  }
  EXPECT_GE(dark, cases / 10);
  EXPECT_LE(dark, cases * 9 / 10);
}

}  // namespace
}  // namespace galactic::test::ambient_oracle_test
