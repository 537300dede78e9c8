// Ambient occlusion where it is known.
#include "ambient/ambient_occlusion.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "occlusion_meshes.h"

namespace galactic::test::ambient_occlusion_test {
namespace {

using bake::LitSides;
using bake::OccludingMesh;
using bake::Openness;
using testing::Each;
using testing::ElementsAre;

/// Of a factor from 1,024 rays.
constexpr float kRayError = 0.015F;
constexpr bake::AmbientOcclusionOptions kManyRays{.rays = 1024};
constexpr Openness kOpen{};

/// Floor and two walls of 1 m that meet at the origin and face each other, in cells of 2.5 cm.
struct CornerOfThree {
  static constexpr unsigned kCells = 40;
  TestMesh floor = sheet({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, kCells);
  TestMesh wall_x = sheet({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, kCells);
  TestMesh wall_z = sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, kCells);

  [[nodiscard]] std::vector<OccludingMesh> placed() const {
    return {floor.placed(), wall_x.placed(), wall_z.placed()};
  }
};

TEST(AmbientOcclusion, LeavesAQuarterInACornerAndAHalfAtAnEdge) {
  const CornerOfThree corner;
  // Rays as long as the walls are high; near the corner they find the walls at once.
  const auto openness = opennessOf(corner.placed(), kManyRays);
  ASSERT_EQ(openness.size(), 3U);
  // The walls end after 1 m, so a little more light comes than under endless ones.
  constexpr float kEnds = 0.01F;
  for (const auto& side : openness) {
    EXPECT_NEAR(side[0].front, 0.25F, kRayError + kEnds);
    constexpr unsigned kMiddle = CornerOfThree::kCells / 2;
    EXPECT_NEAR(side[kMiddle].front, 0.5F, 0.1F);
    EXPECT_NEAR(side[kMiddle * (CornerOfThree::kCells + 1)].front, 0.5F, 0.1F);
    EXPECT_GT(side.back().front, 0.85F);
  }
}

TEST(AmbientOcclusion, IsNoneOnAnOpenPlaneAndOnAConvexBody) {
  const TestMesh plane = sheet({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 5);
  EXPECT_THAT(opennessOf({plane.placed()})[0], Each(kOpen));
  // Eight vertices that three sides share: a mean normal would look into the neighbors.
  EXPECT_THAT(opennessOf({box({0.5F, 0.2F, 0.4F}).placed()})[0], Each(kOpen));
}

TEST(AmbientOcclusion, IsCompleteInsideAClosedBox) {
  EXPECT_THAT(opennessOf({box({0.3F, 0.3F, 0.3F}, true).placed()})[0], Each(Openness{.front = 0}));
}

TEST(AmbientOcclusion, UnderADiscIsItsFormFactor) {
  // A small patch of floor under the middle of a disc: 1 - r^2 / (r^2 + h^2) stays open.
  const TestMesh patch = sheet({-0.01F, 0, -0.01F}, {0, 0, 0.02F}, {0.02F, 0, 0}, 2);
  for (const float height : {0.1F, 0.3F, 0.6F}) {
    TestMesh disc;
    constexpr unsigned kSegments = 128;
    constexpr float kRadius = 0.4F;
    disc.positions.push_back({0, height, 0});
    for (unsigned i = 0; i < kSegments; ++i) {
      const double angle = 2 * std::numbers::pi * i / kSegments;
      disc.positions.push_back({kRadius * static_cast<float>(std::cos(angle)), height,
                                kRadius * static_cast<float>(std::sin(angle))});
      disc.triangles.push_back({0, 1 + i, 1 + (i + 1) % kSegments});
    }
    const auto openness = opennessOf({patch.placed(), disc.placed()}, kManyRays);
    const float wanted = 1 - kRadius * kRadius / (kRadius * kRadius + height * height);
    EXPECT_NEAR(openness[0][4].front, wanted, kRayError) << "height " << height;
  }
}

TEST(AmbientOcclusion, EndsAtTheLargestDistance) {
  const TestMesh floor = sheet({-0.1F, 0, -0.1F}, {0, 0, 0.2F}, {0.2F, 0, 0}, 2);
  const TestMesh lid = sheet({-5, 0.5F, -5}, {10, 0, 0}, {0, 0, 10}, 1);
  const std::vector meshes{floor.placed(), lid.placed()};
  EXPECT_THAT(opennessOf(meshes, {.largest_distance = 0.4F})[0], Each(kOpen));
  EXPECT_LT(opennessOf(meshes, {.largest_distance = 40})[0][4].front, 0.05F);
  // Rays of 1 m reach the lid when they rise by 0.5 m: cos^2 < 0.25 misses it.
  EXPECT_NEAR(opennessOf(meshes, kManyRays)[0][4].front, 0.25F, kRayError);
}

TEST(AmbientOcclusion, PaintsNoDarknessOfCornersOverCoarseWalls) {
  // A room of 12 triangles: the value at its corners would be a quarter.
  const auto openness = opennessOf({box({2, 1.3F, 2.5F}, true).placed()}, kManyRays);
  ASSERT_FALSE(openness[0].empty());
  for (const Openness& value : openness[0]) {
    EXPECT_GT(value.front, 0.6F);
    EXPECT_LT(value.front, 0.95F);
  }
}

TEST(AmbientOcclusion, IsTheSameOnBothSidesOfASeam) {
  // The floor in two pieces with vertices of their own, under a step that makes it uneven.
  TestMesh floor = sheet({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 8);
  const TestMesh other = sheet({1, 0, 0}, {0, 0, 1}, {1, 0, 0}, 8);
  const auto first = static_cast<std::uint32_t>(floor.positions.size());
  floor.positions.insert(floor.positions.end(), other.positions.begin(), other.positions.end());
  for (const bake::Triangle& t : other.triangles) {
    floor.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  const TestMesh step = sheet({0.7F, 0.2F, 0.1F}, {0.2F, 0, 0}, {0, 0, 0.9F}, 1);
  const auto openness = opennessOf({floor.placed(), step.placed()});
  bool shaded = false;
  for (std::size_t i = 0; i < 9; ++i) {
    // The last row of one piece and the first row of the other.
    EXPECT_EQ(openness[0][8 * 9 + i], openness[0][first + i]) << i;
    shaded = shaded || openness[0][first + i].front < 0.9F;
  }
  EXPECT_TRUE(shaded);
}

TEST(AmbientOcclusion, MeasuresTheBackOfATwoSidedSheetWhereItsFrontIsDim) {
  const TestMesh leaf = sheet({-0.1F, 0, -0.1F}, {0, 0, 0.2F}, {0.2F, 0, 0}, 2);
  const TestMesh lid = sheet({-9, 0.05F, -9}, {18, 0, 0}, {0, 0, 18}, 1);
  OccludingMesh placed = leaf.placed();
  const float front = opennessOf({placed, lid.placed()})[0][4].front;
  EXPECT_LT(front, 0.1F);
  EXPECT_EQ(opennessOf({placed, lid.placed()})[0][4].back, 0.F);
  placed.lit = LitSides::kBoth;
  EXPECT_EQ(opennessOf({placed, lid.placed()})[0][4], (Openness{.front = front, .back = 1}));
  EXPECT_EQ(opennessOf({placed, lid.placed()}, {.dim = 0})[0][4].back, 0.F);
  EXPECT_EQ(opennessOf({placed})[0][4], kOpen) << "a bright front is enough";
}

TEST(AmbientOcclusion, MeasuresNothingOfWhatOnlyKeepsLightAway) {
  const TestMesh leaf = sheet({-0.1F, 0, -0.1F}, {0, 0, 0.2F}, {0.2F, 0, 0}, 2);
  const TestMesh lid = sheet({-9, 0.05F, -9}, {18, 0, 0}, {0, 0, 18}, 1);
  OccludingMesh unlit = lid.placed();
  unlit.lit = LitSides::kNone;
  const auto openness = opennessOf({leaf.placed(), unlit});
  EXPECT_LT(openness[0][4].front, 0.1F);
  EXPECT_THAT(openness[1], ElementsAre());
}

TEST(AmbientOcclusion, PassesThroughWhatIsNearerThanTheLeastDistance) {
  const TestMesh leaf = sheet({-0.1F, 0, -0.1F}, {0, 0, 0.2F}, {0.2F, 0, 0}, 2);
  const TestMesh lid = sheet({-9, 0.004F, -9}, {18, 0, 0}, {0, 0, 18}, 1);
  const std::vector meshes{leaf.placed(), lid.placed()};
  EXPECT_LT(opennessOf(meshes)[0][4].front, 0.01F);
  // Rays that graze stay under the lid for longer: cos^2 of those that rise 4 mm in 10 is 0.16.
  EXPECT_NEAR(opennessOf(meshes, {.rays = 1024, .least_distance = 0.01F})[0][4].front, 0.84F,
              kRayError);
}

TEST(AmbientOcclusion, LeavesVerticesWithoutAreaAlone) {
  TestMesh mesh = sheet({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 1);
  mesh.positions.push_back({std::nanf(""), 0, 0});
  mesh.positions.push_back({3, 0, 0});
  mesh.triangles.push_back({5, 5, 5});
  EXPECT_THAT(opennessOf({mesh.placed()})[0], Each(kOpen));
  EXPECT_THAT(opennessOf({}), ElementsAre());
  EXPECT_THAT(opennessOf({OccludingMesh{}}), ElementsAre(std::vector<Openness>()));
}

TEST(AmbientOcclusion, DoesNotDependOnThreads) {
  const CornerOfThree corner;
  const auto once = opennessOf(corner.placed(), {.rays = 16});
  EXPECT_EQ(opennessOf(corner.placed(), {.rays = 16}, 2), once);
  EXPECT_EQ(opennessOf(corner.placed(), {.rays = 16}, 7), once);
}

TEST(AmbientOcclusion, RefusesOptionsOutOfRange) {
  for (const unsigned rays : {0U, 65537U}) {
    const auto result = bake::ambientOcclusion({}, {.rays = rays});
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(result.error().message, std::to_string(rays) + " rays a vertex; give 1 to 65536");
  }
  for (const float distance : {0.F, -1.F, std::nanf(""), INFINITY}) {
    EXPECT_FALSE(bake::ambientOcclusion({}, {.largest_distance = distance}).has_value());
  }
  for (const float distance : {-0.1F, 1.F, std::nanf(""), INFINITY}) {
    EXPECT_FALSE(bake::ambientOcclusion({}, {.least_distance = distance}).has_value());
  }
  for (const float dim : {-0.1F, 1.1F, std::nanf("")}) {
    EXPECT_FALSE(bake::ambientOcclusion({}, {.dim = dim}).has_value());
  }
}

}  // namespace
}  // namespace galactic::test::ambient_occlusion_test
