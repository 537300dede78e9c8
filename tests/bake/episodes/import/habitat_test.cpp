// Rearrangement datasets of Habitat: what they become.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "galactic/bake/episode_set_import.h"
#include "support/gzip_text.h"
#include "support/habitat_text.h"
#include "support/scratch_folder.h"

namespace galactic::test::habitat_test {
namespace {

using bake::EpisodeImportOptions;
using bake::HabitatTargets;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr unsigned kSeed = 20220523;
/// Points within 10 m, through a quaternion in floats.
constexpr double kSamePlace = 5e-6;
constexpr float kHalf = 0.70710678F;
constexpr float kRounding = 1e-6F;

Result<bake::SourceEpisodes> import(std::string_view text, const EpisodeImportOptions& options = {},
                                    const char* name = "tidy.json") {
  const ScratchFolder folder;
  return bake::readEpisodeFile(folder.write(name, text), options);
}

void expectQuat(const Quat& found, const Quat& wanted) {
  EXPECT_NEAR(found.x, wanted.x, kRounding);
  EXPECT_NEAR(found.y, wanted.y, kRounding);
  EXPECT_NEAR(found.z, wanted.z, kRounding);
  EXPECT_NEAR(found.w, wanted.w, kRounding);
}

TEST(HabitatEpisodes, GiveScenesObjectsPlacementsAndGoals) {
  const auto set = import(kSmallHabitatSet);
  ASSERT_TRUE(set.has_value()) << set.error().text();
  EXPECT_EQ(set->name, "tidy");
  EXPECT_THAT(set->scenes, ElementsAre("v3_sc0_staging_00", "v3_sc1_staging_05"));
  EXPECT_THAT(set->objects, ElementsAre("003_cracker_box", "mug"));
  EXPECT_TRUE(set->start_joints.empty());
  EXPECT_TRUE(set->start_positions.empty());
  ASSERT_EQ(set->episodes.size(), 2U);
  const Episode& first = set->episodes[0];
  EXPECT_EQ(first.scene, 1U);
  EXPECT_EQ(first.placement_count, 3U);
  EXPECT_EQ(first.target, 0U) << "the first in the order of rigid_objs";
  EXPECT_EQ(first.goal.translation, (Vec3{-1, 0.25F, -2}));
  expectQuat(first.goal.rotation, {0, kHalf, 0, kHalf});
  ASSERT_EQ(set->placements.size(), 4U);
  EXPECT_EQ(set->placements[0].object, 0U);
  EXPECT_EQ(set->placements[0].pose.translation, (Vec3{0.5F, 1, -0.25F}));
  expectQuat(set->placements[0].pose.rotation, {0, 0, 0, 1});
  expectQuat(set->placements[1].pose.rotation, {0, kHalf, 0, kHalf});
  expectQuat(set->placements[2].pose.rotation, {kHalf, 0, 0, kHalf});
  EXPECT_EQ(set->placements[2].pose.translation, (Vec3{4, 0.5F, 5}));
  EXPECT_EQ(set->episodes[1].scene, 0U);
  EXPECT_EQ(set->episodes[1].first_placement, 3U);
}

TEST(HabitatEpisodes, StartTheRobotWithItsHeading) {
  const auto set = import(kSmallHabitatSet);
  ASSERT_TRUE(set.has_value());
  EXPECT_EQ(set->episodes[0].base_position, (Vec3{1.5F, 0.125F, -2.5F}));
  EXPECT_NEAR(set->episodes[0].base_yaw, 1.5707963F, kRounding);
  EXPECT_EQ(set->episodes[1].base_position, (Vec3{}));
  EXPECT_EQ(set->episodes[1].base_yaw, 0);
  EXPECT_THAT(set->without_start, ElementsAre(1)) << "as habitat-lab's generator has it";
}

TEST(HabitatEpisodes, WarnOfWhatAPackCannotHold) {
  const auto set = import(kSmallHabitatSet);
  ASSERT_TRUE(set.has_value());
  EXPECT_THAT(
      set->warnings,
      ElementsAre(
          "1 of 2 episodes have several targets; the first is kept, `targets` each makes an "
          "episode of each",
          "1 of 2 episodes open furniture (ao_states), which stands in the scenes' packs as they "
          "were baked",
          "2 objects, first '003_cracker_box', stand with their origins where their centers "
          "belong; give `object-pack`, unless these are the same"));
}

TEST(HabitatEpisodes, MakeAnEpisodeOfEachTargetWhereThatIsAskedFor) {
  EpisodeImportOptions options;
  options.targets = HabitatTargets::kEach;
  const auto set = import(kSmallHabitatSet, options);
  ASSERT_TRUE(set.has_value());
  ASSERT_EQ(set->episodes.size(), 3U);
  EXPECT_EQ(set->episodes[0].target, 0U);
  EXPECT_EQ(set->episodes[1].target, 2U) << "mug_:0001 is the second mug";
  EXPECT_EQ(set->episodes[1].goal.translation, (Vec3{0.75F, 0.5F, 1.75F}));
  EXPECT_EQ(set->episodes[1].first_placement, 3U) << "packs share no placements";
  EXPECT_EQ(set->placements.size(), 7U);
  EXPECT_THAT(set->warnings, Not(Contains(HasSubstr("several targets"))));
}

TEST(HabitatEpisodes, AreReadCompressedToo) {
  const auto plain = import(kSmallHabitatSet);
  const auto packed = import(gzipped(kSmallHabitatSet), {}, "tidy.json.gz");
  ASSERT_TRUE(plain.has_value() && packed.has_value());
  EXPECT_EQ(packed->name, "tidy");
  EXPECT_EQ(packed->objects, plain->objects);
  EXPECT_EQ(packed->warnings, plain->warnings);
  EXPECT_EQ(packed->placements.size(), plain->placements.size());
}

TEST(HabitatEpisodes, KeepAndRenameWhatIsAskedFor) {
  EpisodeImportOptions options;
  options.only = std::vector<std::uint32_t>{1};
  options.scene_names = {{"v3_sc0_staging_00", "flat"}};
  const auto set = import(kSmallHabitatSet, options);
  ASSERT_TRUE(set.has_value()) << set.error().message;
  EXPECT_THAT(set->scenes, ElementsAre("flat"));
  EXPECT_THAT(set->objects, ElementsAre("mug"));
  EXPECT_THAT(set->without_start, ElementsAre(0)) << "among those that are kept";
  options.scene_names = {{"attic", "flat"}};
  const auto none = import(kSmallHabitatSet, options);
  ASSERT_FALSE(none.has_value());
  EXPECT_THAT(none.error().message, HasSubstr("has no scene 'attic' to be named 'flat'"));
  options.scene_names = {{"v3_sc0_staging_00", "v3_sc1_staging_05"}};
  const auto two = import(kSmallHabitatSet, options);
  ASSERT_FALSE(two.has_value());
  EXPECT_THAT(two.error().message, HasSubstr("is the name of two scenes"));
}

TEST(HabitatEpisodes, PutObjectsWhereTheirCentersBelong) {
  EpisodeImportOptions options;
  options.object_centers = {{"003_cracker_box", {0.1F, 0.2F, 0.3F}}, {"mug", {0, 0.05F, 0}}};
  const auto set = import(kSmallHabitatSet, options);
  ASSERT_TRUE(set.has_value());
  // No turn: straight back. A quarter about X: the center is 5 cm along Z of the world.
  const Vec3 first = set->placements[0].pose.translation;
  EXPECT_NEAR(first.x, 0.4F, kRounding);
  EXPECT_NEAR(first.y, 0.8F, kRounding);
  EXPECT_NEAR(first.z, -0.55F, kRounding);
  const Vec3 third = set->placements[2].pose.translation;
  EXPECT_NEAR(third.x, 4, kRounding);
  EXPECT_NEAR(third.y, 0.5F, kRounding);
  EXPECT_NEAR(third.z, 4.95F, kRounding);
  options.object_centers.erase("mug");
  options.centers_needed = true;
  const auto missing = import(kSmallHabitatSet, options);
  ASSERT_FALSE(missing.has_value());
  EXPECT_THAT(missing.error().where, HasSubstr("episodes[0].rigid_objs[1][1]"));
  EXPECT_EQ(missing.error().message,
            "is of 'mug', which is not in the object pack; bake it into it");
}

/// Rows of a rotation matrix and a translation as JSON.
using Matrix = std::array<std::array<double, 4>, 3>;

std::string jsonOf(const Matrix& m) {
  std::string text = "[";
  for (const auto& row : m) {
    text += "[";
    for (std::size_t n = 0; n < 4; ++n) text += (n > 0 ? ", " : "") + std::to_string(row[n]);
    text += "], ";
  }
  return text + "[0, 0, 0, 1]]";
}

/// A random rotation by Rodrigues' formula, a random place.
Matrix randomMatrix(std::mt19937& random) {
  const auto number = [&random](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967295.0);
  };
  std::array<double, 3> axis{number(-1, 1), number(-1, 1), number(0.1, 1)};
  const double length = std::hypot(axis[0], axis[1], axis[2]);
  for (double& part : axis) part /= length;
  const double angle = number(-3.14159, 3.14159);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const std::array<std::array<double, 3>, 3> turned{
      {{0, -axis[2], axis[1]}, {axis[2], 0, -axis[0]}, {-axis[1], axis[0], 0}}};
  Matrix m{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      m[i][j] = (i == j ? c : 0) + s * turned[i][j] + (1 - c) * axis[i] * axis[j];
    }
    m[i][3] = number(-5, 5);
  }
  return m;
}

TEST(HabitatEpisodes, PutEveryPointWhereTheMatrixPutsIt) {
  std::mt19937 random(kSeed);
  std::size_t tilted = 0;
  constexpr int kCases = 200;
  for (int n = 0; n < kCases; ++n) {
    const Matrix m = randomMatrix(random);
    if (m[1][1] > 0) ++tilted;
    const std::string matrix = jsonOf(m);
    const Vec3 center{0.25F, -0.5F, 0.125F};
    EpisodeImportOptions options;
    options.object_centers = {{"mug", center}};
    const auto set = import(
        R"({"episodes": [{"scene_id": "s", "start_position": [0, 0, 0],
            "start_rotation": [0, 0, 0, 1], "rigid_objs": [["mug", )" +
            matrix + R"(]], "targets": {"mug_:0000": )" + matrix + "}}]}",
        options);
    ASSERT_TRUE(set.has_value()) << set.error().text();
    EXPECT_EQ(set->episodes[0].goal, set->placements[0].pose);
    // A point of the pack's frame is (center + p); the matrix counts from the center.
    const Vec3 p{0.3F, 0.7F, -0.9F};
    const Vec3 found = set->placements[0].pose * (center + p);
    const std::array<double, 3> q{0.3, 0.7, -0.9};
    const std::array<double, 3> world{static_cast<double>(found.x), static_cast<double>(found.y),
                                      static_cast<double>(found.z)};
    for (std::size_t i = 0; i < 3; ++i) {
      const double wanted = m[i][0] * q[0] + m[i][1] * q[1] + m[i][2] * q[2] + m[i][3];
      EXPECT_NEAR(world[i], wanted, kSamePlace);
    }
  }
  EXPECT_GT(tilted, kCases / 10U);
  EXPECT_LT(tilted, kCases * 9U / 10U);
}

TEST(HabitatEpisodes, TakeFilesWithoutWhatIsNotNeeded) {
  const auto set = import(
      R"({"episodes": [{"scene_id": "00001/mesh.basis.glb", "start_position": [0, 0, 0],
          "start_rotation": [0, 0, 0, 1], "color": 1,
          "rigid_objs": [["a.b.object_config.json", [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]]],
          "targets": {"a.b_:0000": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}}]})");
  ASSERT_TRUE(set.has_value()) << set.error().text();
  EXPECT_THAT(set->scenes, ElementsAre("mesh"));
  EXPECT_THAT(set->objects, ElementsAre("a.b"));
  EXPECT_THAT(set->warnings, Contains("episodes[0].color is not used"));
}

}  // namespace
}  // namespace galactic::test::habitat_test
