// Placement of many random instances against points placed one by one in another way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "bake/dataset/small_dataset.h"
#include "dataset/scene_dataset.h"

namespace galactic::test::placement_test {
namespace {

using Point = std::array<double, 3>;

constexpr unsigned kSeed = 20250611;
/// Coordinates reach 60 m and are stored as doubles, but the mesh's points are floats.
constexpr double kTolerance = 2e-5;

Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point operator*(const Point& a, const Point& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }
Point scaled(const Point& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// `p` turned by the quaternion (w, u) as v + 2w(u x v) + 2u x (u x v), without a matrix.
Point turned(const std::array<double, 4>& q, const Point& p) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const Point u{q[1] / length, q[2] / length, q[3] / length};
  const Point first = cross(u, p);
  return p + scaled(first, 2 * q[0] / length) + scaled(cross(u, first), 2);
}

/// One template as the test writes it.
struct Template {
  std::string name;
  Point scale{1, 1, 1};
  Point up{0, 1, 0};
  Point front{0, 0, -1};
  std::optional<Point> center_of_mass = std::nullopt;
};

/// One instance as the test writes it.
struct Item {
  std::size_t of = 0;
  Point translation{};
  std::array<double, 4> rotation{};
  Point scale{1, 1, 1};
  double uniform = 1;
  bool moves = false;
  bool asset_origin = false;
};

std::string listOf(const auto& values) {
  std::string list;
  for (const double v : values) list += fmt::format("{}{}", list.empty() ? "" : ", ", v);
  return "[" + list + "]";
}

/// The corners of the mesh in the frame of the object, one point after the other.
std::vector<Point> expectedInObject(const Template& of, const Item& item) {
  const Point right = cross(of.front, of.up);
  std::vector<Point> points;
  for (const Point& p : boxCorners()) {
    const Point framed{dot(right, p), dot(of.up, p), -dot(of.front, p)};
    points.push_back(scaled(framed * of.scale * item.scale, item.uniform));
  }
  return points;
}

/// Where they come to lie.
std::vector<Point> expected(const Template& of, const Item& item) {
  std::vector<Point> points = expectedInObject(of, item);
  Point low{1e9, 1e9, 1e9};
  Point high{-1e9, -1e9, -1e9};
  for (const Point& p : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  Point center = scaled(low + high, 0.5);
  if (of.center_of_mass) {
    center = scaled(*of.center_of_mass * of.scale * item.scale, item.uniform);
  }
  if (item.asset_origin) center = {};
  for (Point& p : points) p = turned(item.rotation, p - center) + item.translation;
  return points;
}

class RandomScene {
 public:
  explicit RandomScene(std::size_t count) : random_(kSeed) {
    templates_ = {{.name = "plain", .center_of_mass = Point{0, 0, 0}},
                  {.name = "centered"},
                  {.name = "weighted", .scale = {0.5, 2, 1}, .center_of_mass = Point{1, -2, 0.5}},
                  {.name = "lying", .up = {0, 0, 1}, .front = {0, 1, 0}},
                  {.name = "askew",
                   .scale = {1, 1, 3},
                   .up = {0.6, 0.8, 0},
                   .front = {-0.8, 0.6, 0},
                   .center_of_mass = Point{0.25, 0.5, 0.75}}};
    for (std::size_t i = 0; i < count; ++i) items_.push_back(randomItem());
  }

  void writeTo(const SmallDataset& small) const {
    for (const Template& one : templates_) {
      std::string json = fmt::format(
          R"({{"render_asset": "../../../meshes/box.obj", "scale": {}, "up": {}, "front": {})",
          listOf(one.scale), listOf(one.up), listOf(one.front));
      if (one.center_of_mass) json += fmt::format(R"(, "COM": {})", listOf(*one.center_of_mass));
      small.write("configs/objects/big/" + one.name + ".object_config.json", json + "}");
    }
    std::string objects;
    for (const Item& item : items_) {
      objects += fmt::format(
          R"({}{{"template_name": "{}", "motion_type": "{}", "translation": {}, "rotation": {},
              "non_uniform_scale": {}, "uniform_scale": {}, "translation_origin": "{}"}})",
          objects.empty() ? "" : ",\n", templates_[item.of].name, item.moves ? "DYNAMIC" : "STATIC",
          listOf(item.translation), listOf(item.rotation), listOf(item.scale), item.uniform,
          item.asset_origin ? "ASSET_LOCAL" : "COM");
    }
    small.writeScene("random", fmt::format(R"({{"stage_instance": {{"template_name": "NONE"}},
        "object_instances": [{}]}})",
                                           objects));
  }

  [[nodiscard]] const std::vector<Template>& templates() const { return templates_; }
  [[nodiscard]] const std::vector<Item>& items() const { return items_; }

 private:
  /// -1 to 1; the same everywhere, unlike the distributions of the library.
  double uniform() { return static_cast<double>(random_()) / 2147483647.5 - 1; }

  Item randomItem() {
    Item item;
    item.of = random_() % templates_.size();
    for (double& v : item.translation) v = 20 * uniform();
    for (double& v : item.rotation) v = uniform();
    item.moves = random_() % 3 == 0;
    item.asset_origin = random_() % 2 == 0;
    if (random_() % 2 == 0) {
      // Negative scales mirror.
      for (double& v : item.scale) v = (random_() % 4 == 0 ? -1 : 1) * (1.25 + uniform());
    }
    if (random_() % 2 == 0) item.uniform = 1.25 + uniform();
    return item;
  }

  std::mt19937 random_;
  std::vector<Template> templates_;
  std::vector<Item> items_;
};

/// That `m` takes the corners of the mesh to `wanted`, one by one and not only as a set.
void expectCorners(const bake::Affine& m, const std::vector<Point>& wanted) {
  const std::vector<Point> corners = boxCorners();
  ASSERT_EQ(corners.size(), wanted.size());
  for (std::size_t n = 0; n < corners.size(); ++n) {
    const Point& p = corners[n];
    const Point found{m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3],
                      m[4] * p[0] + m[5] * p[1] + m[6] * p[2] + m[7],
                      m[8] * p[0] + m[9] * p[1] + m[10] * p[2] + m[11]};
    EXPECT_LT(farthestCorner({found}, {wanted[n]}), kTolerance);
  }
}

TEST(Placement, OfRandomInstancesIsThatOfTheirPoints) {
  constexpr std::size_t kCount = 300;
  const SmallDataset small;
  const RandomScene random(kCount);
  random.writeTo(small);
  const auto dataset = bake::SceneDataset::read(small.config());
  ASSERT_TRUE(dataset) << dataset.error().message;
  bake::MeshLibrary meshes(bake::datasetMeshOptions());
  const auto scene = dataset->compose("random", meshes);
  ASSERT_TRUE(scene) << scene.error().text();
  const auto survey = dataset->survey("random");
  ASSERT_TRUE(survey) << survey.error().text();
  std::size_t fixed = 0;
  std::size_t movable = 0;
  std::size_t origins = 0;
  std::size_t computed_centers = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    SCOPED_TRACE(i);
    const Item& item = random.items()[i];
    const Template& of = random.templates()[item.of];
    origins += item.asset_origin ? 1U : 0U;
    computed_centers += of.center_of_mass ? 0U : 1U;
    if (item.moves) {
      ASSERT_LT(movable, survey->movable.size());
      const bake::DatasetObject& object = survey->movable[movable++];
      EXPECT_EQ(object.name, of.name);
      expectCorners(object.object_from_mesh, expectedInObject(of, item));
    } else {
      ASSERT_LT(fixed, scene->scene.instances.size());
      const auto& instance = scene->scene.instances[fixed++];
      EXPECT_THAT(instance.name, testing::StartsWith(of.name + "_:"));
      const std::vector<Point> wanted = expected(of, item);
      EXPECT_LT(farthestCorner(placedVertices(scene->scene, instance), wanted), kTolerance);
      expectCorners(instance.world_from_mesh, wanted);
    }
  }
  EXPECT_EQ(fixed, scene->scene.instances.size());
  EXPECT_EQ(movable, survey->movable.size());
  for (const std::size_t count : {movable, origins, computed_centers}) {
    EXPECT_GT(count, kCount / 10);
    EXPECT_LT(count, 9 * kCount / 10);
  }
}

}  // namespace
}  // namespace galactic::test::placement_test
