#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <random>

#include "pack_tool/mesh/grid_mesh.h"
#include "support/pack_tool_fixture.h"

namespace galactic::pack_tool::mesh_test {
namespace {

using test::GridBuilder;
using test::GridSpec;
using testing::HasSubstr;

constexpr unsigned kSeed = 20230610;

bool covers(const Patch& patch, GroundPoint point) {
  return point.x > static_cast<double>(patch.min_x) && point.x < static_cast<double>(patch.max_x) &&
         point.z > static_cast<double>(patch.min_z) && point.z < static_cast<double>(patch.max_z);
}

TEST(GridPatches, JoinCellsOfOneHeightToRectangles) {
  GridBuilder builder(GridSpec{});
  for (std::uint32_t k = 0; k < 3; ++k) {
    for (std::uint32_t i = 1; i < 4; ++i) builder.column(i, k, {{1, 2}});
  }
  const auto grid = builder.build();
  const auto patches = gridPatches(grid.view(), {});
  ASSERT_EQ(patches.size(), 2U);
  for (const Patch& patch : patches) {
    EXPECT_EQ(patch.min_x, 1);
    EXPECT_EQ(patch.max_x, 4);
    EXPECT_EQ(patch.min_z, 0);
    EXPECT_EQ(patch.max_z, 3);
    EXPECT_EQ(patch.y, patch.side == Patch::Side::kFloor ? 1 : 2);
  }
}

TEST(GridPatches, CoverEachSpanEndOfEachColumnExactlyOnce) {
  std::mt19937 random(kSeed);
  const auto grid = test::randomGrid(GridSpec{.columns_x = 24, .columns_z = 17}, random);
  const auto patches = gridPatches(grid.view(), {});
  std::vector<Span> spans;
  std::size_t ends = 0;
  for (std::uint32_t k = 0; k < 17; ++k) {
    for (std::uint32_t i = 0; i < 24; ++i) {
      std::multimap<float, Patch::Side> found;
      for (const Patch& patch : patches) {
        if (covers(patch, columnCenter(grid.view(), {i, k}))) found.emplace(patch.y, patch.side);
      }
      readSpans(grid.view(), {i, k}, spans);
      std::multimap<float, Patch::Side> wanted;
      for (const Span& span : spans) {
        wanted.emplace(span.lo, Patch::Side::kFloor);
        wanted.emplace(span.hi, Patch::Side::kCeiling);
      }
      ASSERT_EQ(found, wanted) << "seed " << kSeed << " cell " << i << ", " << k;
      ends += wanted.size();
    }
  }
  EXPECT_GT(ends, 400U);
}

TEST(GridPatches, CoverEachFloorOnceWhereHeightsRepeat) {
  // Few heights, so that runs and rectangles of all shapes meet.
  std::mt19937 random(kSeed);
  std::uniform_int_distribution<int> step(0, 2);
  GridBuilder builder(GridSpec{.columns_x = 30, .columns_z = 30});
  for (std::uint32_t k = 0; k < 30; ++k) {
    for (std::uint32_t i = 0; i < 30; ++i) {
      const int height = step(random);
      if (height > 0) builder.column(i, k, {{static_cast<float>(height), 4}});
    }
  }
  const auto grid = builder.build();
  const auto patches = gridPatches(grid.view(), {.parts = MeshParts::kFloors});
  int free = 0;
  for (std::uint32_t k = 0; k < 30; ++k) {
    for (std::uint32_t i = 0; i < 30; ++i) {
      const std::size_t wanted = grid.view().spanCount(i, k);
      std::size_t found = 0;
      for (const Patch& patch : patches) {
        if (!covers(patch, columnCenter(grid.view(), {i, k}))) continue;
        ++found;
        EXPECT_EQ(patch.y, grid.columns[std::size_t{k} * 30 + i].front().lo);
      }
      ASSERT_EQ(found, wanted) << "seed " << kSeed << " cell " << i << ", " << k;
      free += wanted > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(free, 90);
  EXPECT_LT(free, 810);
  EXPECT_LT(patches.size(), static_cast<std::size_t>(free));
}

TEST(GridPatches, MoveByTheRadiusToTheSurface) {
  const auto grid = GridBuilder(GridSpec{}).column(0, 0, {{1, 2}}).build();
  const auto patches = gridPatches(grid.view(), {.height = PatchHeight::kSurface});
  ASSERT_EQ(patches.size(), 2U);
  for (const Patch& patch : patches) {
    EXPECT_EQ(patch.y, patch.side == Patch::Side::kFloor ? 0.5F : 2.5F);
  }
}

/// The corners of a quad in a PLY file whose vertices take 15 bytes each.
Vec3 plyVertex(const std::string& body, std::size_t index) {
  Vec3 vertex;
  std::memcpy(&vertex, body.data() + index * 15, sizeof vertex);
  return vertex;
}

TEST(EncodePly, HoldsQuadsThatFaceFreeSpace) {
  const auto grid = GridBuilder(GridSpec{}).column(2, 1, {{1, 2}}).build();
  const std::string file = encodePly(gridPatches(grid.view(), {}));
  EXPECT_THAT(file, HasSubstr("element vertex 8\n"));
  EXPECT_THAT(file, HasSubstr("element face 2\n"));
  const std::string end = "end_header\n";
  const std::string body = file.substr(file.find(end) + end.size());
  ASSERT_EQ(body.size(), 8U * 15 + 2U * 17);
  for (std::size_t quad = 0; quad < 2; ++quad) {
    const Vec3 a = plyVertex(body, 4 * quad);
    const Vec3 b = plyVertex(body, 4 * quad + 1);
    const Vec3 c = plyVertex(body, 4 * quad + 2);
    // y of (b - a) x (c - a): up for the floor at 1, down for the ceiling at 2.
    const float normal_y = (b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z);
    EXPECT_GT(a.y == 1 ? normal_y : -normal_y, 0);
  }
}

TEST(EncodeObj, NumbersItsVerticesFromOne) {
  const auto grid = GridBuilder(GridSpec{}).column(0, 0, {{1, 2.5F}}).build();
  EXPECT_EQ(encodeObj(gridPatches(grid.view(), {})),
            "# free space of a column grid; meters, Y up\n"
            "o floors\nv 0 1 0\nv 0 1 1\nv 1 1 1\nv 1 1 0\nf 1 2 3 4\n"
            "o ceilings\nv 0 2.5 0\nv 1 2.5 0\nv 1 2.5 1\nv 0 2.5 1\nf 5 6 7 8\n");
}

TEST(EncodePly, AcceptsAGridWithoutFreeSpace) {
  const auto grid = GridBuilder(GridSpec{}).build();
  EXPECT_THAT(encodePly(gridPatches(grid.view(), {})), HasSubstr("element vertex 0\n"));
}

}  // namespace
}  // namespace galactic::pack_tool::mesh_test
