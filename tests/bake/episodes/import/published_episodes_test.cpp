// The published episodes, and where they put real objects.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "galactic/bake/episode_set_import.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/triangle_mesh.h"
#include "recipe/collection_import.h"
#include "support/asset_mesh.h"
#include "support/try.h"

namespace galactic::test::published_episodes_test {
namespace {

using bake::readEpisodeSet;
using nlohmann::json;
using testing::ElementsAre;
using Point = std::array<double, 3>;

constexpr const char* kWorkload = "published_physics/episodes.episode_set.json";
constexpr const char* kGoodEpisodes = "published_physics/good_episodes.txt";
constexpr const char* kTenEpisodes = "galactic/data/tidy_house_10ep.episode_set.json";
constexpr const char* kCollection = "galactic/data/replicacad_composite.collection.json";

/// Poses are rounded to floats: 10 m from the origin to half a micrometer; rotations to 1e-7.
constexpr double kSamePlace = 2e-6;
/// The published boxes are those of the meshes' vertices.
constexpr double kSameBox = 1e-6;

/// By the textbook: v + 2 w (u x v) + 2 u x (u x v) for a quaternion w, u.
Point turned(const std::array<double, 4>& q, const Point& v) {
  const auto cross = [](const Point& a, const Point& b) {
    return Point{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const Point u{q[1], q[2], q[3]};
  const Point once = cross(u, v);
  const Point again = cross(u, once);
  Point result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = v[i] + 2 * (q[0] * once[i] + again[i]);
  return result;
}

double distance(const Point& a, const Vec3& b) {
  return std::hypot(a[0] - static_cast<double>(b.x), a[1] - static_cast<double>(b.y),
                    a[2] - static_cast<double>(b.z));
}

Result<bake::TriangleMesh> meshOf(const std::string& name, bake::UpAxis up) {
  bake::MeshImportOptions options;
  options.up = up;
  ASSIGN_OR_RETURN(auto asset,
                   bake::importMesh(assetsFolder() / "ycb" / name / "textured.obj", options));
  ASSIGN_OR_RETURN(auto clean, bake::placeAndClean(asset));
  return std::move(clean.mesh);
}

TEST(PublishedEpisodes, AreReadWhole) {
  if (!hasAsset(kWorkload)) GTEST_SKIP() << "no asset " << kWorkload;
  const auto set = readEpisodeSet(assetsFolder() / kWorkload);
  ASSERT_TRUE(set.has_value()) << set.error().text();
  EXPECT_THAT(set->scenes, ElementsAre("Baked_sc1_staging_01"));
  EXPECT_THAT(set->objects,
              ElementsAre("002_master_chef_can", "003_cracker_box", "004_sugar_box",
                          "005_tomato_soup_can", "007_tuna_fish_can", "008_pudding_box",
                          "009_gelatin_box", "010_potted_meat_can", "024_bowl"));
  EXPECT_EQ(set->episodes.size(), 100U);
  EXPECT_EQ(set->placements.size(), 3000U);
  EXPECT_EQ(set->start_positions.size(), 700U);
  EXPECT_TRUE(set->warnings.empty());
  EXPECT_NEAR(set->episodes[0].base_yaw, 0.1785167F, 1e-6F);
}

TEST(PublishedEpisodes, KeepTheUsableOnesOfTheWorkload) {
  if (!hasAsset(kWorkload)) GTEST_SKIP() << "no asset " << kWorkload;
  const auto good = bake::readEpisodeList(assetsFolder() / kGoodEpisodes);
  ASSERT_TRUE(good.has_value()) << good.error().message;
  bake::EpisodeImportOptions options;
  options.only = *good;
  options.scene_names = {{"Baked_sc1_staging_01", "scene"}};
  const auto set = readEpisodeSet(assetsFolder() / kWorkload, options);
  ASSERT_TRUE(set.has_value()) << set.error().text();
  EXPECT_EQ(set->episodes.size(), 99U);
  EXPECT_EQ(set->placements.size(), 2970U);
  EXPECT_THAT(set->scenes, ElementsAre("scene"));
}

TEST(PublishedEpisodes, LeaveOutTheScenesThatNoneUses) {
  if (!hasAsset(kTenEpisodes)) GTEST_SKIP() << "no asset " << kTenEpisodes;
  const auto set = readEpisodeSet(assetsFolder() / kTenEpisodes);
  ASSERT_TRUE(set.has_value()) << set.error().text();
  EXPECT_THAT(set->scenes, ElementsAre("Baked_sc1_staging_01"));
  EXPECT_EQ(set->episodes.size(), 10U);
  EXPECT_EQ(set->placements.size(), 300U);
}

/// One object of the collection and the mesh that it was made from.
struct RealObject {
  std::string name;
  bake::CollectionObject published;
  bake::TriangleMesh in_file;
  bake::TriangleMesh in_pack;
};

/// The farthest of our vertices from where the file puts them, over spawns of the object.
double farthest(const RealObject& object, const json& set, const bake::SourceEpisodes& ours,
                std::size_t& spawns) {
  double worst = 0;
  for (std::size_t n = 0; n < ours.placements.size(); ++n) {
    // All episodes are read, and they use the spawns one after the other.
    const json& spawn = set["freeObjectSpawns"][n];
    if (ours.objects[ours.placements[n].object] != object.name) continue;
    ++spawns;
    if (spawns > 20) break;
    const auto rotation = spawn["startRotation"].get<std::array<double, 4>>();
    const auto place = spawn["startPos"].get<Point>();
    for (std::size_t v = 0; v < object.in_file.vertices.size(); v += 101) {
      const Vec3& vertex = object.in_file.vertices[v];
      Point wanted = turned(rotation, {static_cast<double>(vertex.x), static_cast<double>(vertex.y),
                                       static_cast<double>(vertex.z)});
      for (std::size_t i = 0; i < 3; ++i) wanted[i] += place[i];
      worst =
          std::max(worst, distance(wanted, ours.placements[n].pose * object.in_pack.vertices[v]));
    }
  }
  return worst;
}

/// A corner of the box of all vertices, in the frame of the mesh.
Point corner(const bake::Bounds& bounds, unsigned which) {
  return {static_cast<double>((which & 1U) != 0 ? bounds.max.x : bounds.min.x),
          static_cast<double>((which & 2U) != 0 ? bounds.max.y : bounds.min.y),
          static_cast<double>((which & 4U) != 0 ? bounds.max.z : bounds.min.z)};
}

class PublishedObjects : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string mesh = std::string("ycb/") + GetParam() + "/textured.obj";
    if (!hasAsset(kWorkload) || !hasAsset(mesh)) GTEST_SKIP() << "no asset " << mesh;
    const auto collection = bake::readCollection(assetsFolder() / kCollection);
    ASSERT_TRUE(collection.has_value()) << collection.error().message;
    object_.name = GetParam();
    for (const bake::CollectionObject& one : collection->objects) {
      if (one.name == object_.name) object_.published = one;
    }
    auto in_file = meshOf(object_.name, bake::UpAxis::kY);
    auto in_pack = meshOf(object_.name, bake::UpAxis::kZ);
    ASSERT_TRUE(in_file.has_value() && in_pack.has_value());
    object_.in_file = std::move(*in_file);
    object_.in_pack = std::move(*in_pack);
    std::ifstream stream(assetsFolder() / kWorkload);
    set_ = json::parse(stream)["episodeSet"];
  }

  RealObject object_;
  json set_;
};

TEST_P(PublishedObjects, StandWhereThePublishedFilePutsThem) {
  const auto ours = readEpisodeSet(assetsFolder() / kWorkload);
  ASSERT_TRUE(ours.has_value());
  std::size_t spawns = 0;
  EXPECT_LT(farthest(object_, set_, *ours, spawns), kSamePlace);
  EXPECT_GT(spawns, 10U);
  bake::EpisodeImportOptions wrong;
  wrong.object_up = bake::UpAxis::kY;
  const auto lying = readEpisodeSet(assetsFolder() / kWorkload, wrong);
  ASSERT_TRUE(lying.has_value());
  spawns = 0;
  EXPECT_GT(farthest(object_, set_, *lying, spawns), 0.05) << "the frame matters";
}

TEST_P(PublishedObjects, HaveTheirPublishedBoxAtEverySpawn) {
  // The published box is that of the file's frame.
  const bake::Bounds& in_file = object_.in_file.bounds;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(corner(in_file, 0)[i], object_.published.box_min[i], kSameBox);
    EXPECT_NEAR(corner(in_file, 7)[i], object_.published.box_max[i], kSameBox);
  }
  const auto ours = readEpisodeSet(assetsFolder() / kWorkload);
  ASSERT_TRUE(ours.has_value());
  std::size_t compared = 0;
  for (std::size_t n = 0; n < ours->placements.size(); ++n) {
    if (ours->objects[ours->placements[n].object] != object_.name) continue;
    const json& spawn = set_["freeObjectSpawns"][n];
    const auto rotation = spawn["startRotation"].get<std::array<double, 4>>();
    const auto place = spawn["startPos"].get<Point>();
    for (unsigned which = 0; which < 8; ++which) {
      Point local = object_.published.box_min;
      for (std::size_t i = 0; i < 3; ++i) {
        if ((which >> i & 1U) != 0) local[i] = object_.published.box_max[i];
      }
      Point wanted = turned(rotation, local);
      for (std::size_t i = 0; i < 3; ++i) wanted[i] += place[i];
      double nearest = HUGE_VAL;
      for (unsigned other = 0; other < 8; ++other) {
        const Point mine = corner(object_.in_pack.bounds, other);
        const Vec3 in_world = ours->placements[n].pose * Vec3{static_cast<float>(mine[0]),
                                                              static_cast<float>(mine[1]),
                                                              static_cast<float>(mine[2])};
        nearest = std::min(nearest, distance(wanted, in_world));
      }
      EXPECT_LT(nearest, kSamePlace);
    }
    ++compared;
  }
  EXPECT_GT(compared, 100U);
}

INSTANTIATE_TEST_SUITE_P(Ycb, PublishedObjects,
                         testing::Values("003_cracker_box", "024_bowl", "005_tomato_soup_can"),
                         [](const auto& object) { return std::string(object.param).substr(4); });

}  // namespace
}  // namespace galactic::test::published_episodes_test
