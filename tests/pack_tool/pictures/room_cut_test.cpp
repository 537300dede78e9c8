// Scenes that are cut open like floor plans.
#include "pack_tool/pictures/room_cut.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace galactic::pictures::room_cut_test {
namespace {

struct Box {
  Vec3 low;
  Vec3 high;
};

/// Four corners, counter-clockwise from the front.
void addQuad(RenderSurface& surface, const std::array<Vec3, 4>& corners) {
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (const Vec3& corner : corners) surface.vertices.push_back({.position = corner});
  for (const std::uint32_t n : {0U, 1U, 2U, 0U, 2U, 3U}) surface.corners.push_back(first + n);
}

enum class Facing { kOut, kIn };

void addBox(RenderSurface& surface, const Box& box, Facing facing = Facing::kOut) {
  const auto& [a, b] = box;
  std::array<std::array<Vec3, 4>, 6> sides{
      {{{{b.x, a.y, b.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}}},
       {{{a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z}}},
       {{{a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}}},
       {{{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}}},
       {{{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}}},
       {{{b.x, a.y, a.z}, {a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}}}}};
  for (auto& side : sides) {
    if (facing == Facing::kIn) std::ranges::reverse(side);
    addQuad(surface, side);
  }
}

std::vector<SectionLine> sectionOf(RenderSurface& surface, float height) {
  std::vector<SectionLine> section;
  cutThrough({height, height}, surface, section);
  return section;
}

bool covers(const std::vector<SectionRect>& rects, float x, float z) {
  return std::ranges::any_of(rects, [&](const SectionRect& r) {
    return r.low_x <= x && x < r.high_x && r.low_z <= z && z < r.high_z;
  });
}

/// A house of boxes around 6 x 4 m, 2.5 m high, with a door in the front wall and a wall between
/// two rooms.
RenderSurface houseOfBoxes() {
  RenderSurface house;
  addBox(house, {{-0.2F, 0, -0.2F}, {6.2F, 2.5F, 0}});
  addBox(house, {{-0.2F, 0, 4}, {6.2F, 2.5F, 4.2F}});
  addBox(house, {{-0.2F, 0, -0.2F}, {0, 2.5F, 4.2F}});
  addBox(house, {{6, 0, -0.2F}, {6.2F, 2.5F, 1}});
  addBox(house, {{6, 0, 2}, {6.2F, 2.5F, 4.2F}});
  addBox(house, {{6, 2, 1}, {6.2F, 2.5F, 2}});
  addBox(house, {{3, 0, 0}, {3.2F, 2.5F, 3}});
  return house;
}

TEST(RoomCut, FillsWallsOfBoxesAndLeavesRoomsAndDoorsOpen) {
  RenderSurface house = houseOfBoxes();
  const auto section = sectionOf(house, 1.2F);
  for (const RenderVertex& vertex : house.vertices) {
    if (vertex.position.y > 1.2F) continue;
    EXPECT_GE(vertex.position.y, 0);
  }
  for (const std::uint32_t corner : house.corners) {
    EXPECT_LE(house.vertices[corner].position.y, 1.2F);
  }
  for (const double cell : {0.02, 0.05, 0.1}) {
    const auto rects = filledSection(section, cell);
    for (const auto& [x, z] : {std::array{3.0F, -0.1F},
                               {-0.1F, 2.0F},
                               {6.1F, 0.5F},
                               {6.1F, 3.0F},
                               {3.1F, 1.5F},
                               {-0.1F, -0.1F},
                               {6.1F, 4.1F}}) {
      EXPECT_TRUE(covers(rects, x, z)) << "wall at " << x << ", " << z << ", cell " << cell;
    }
    for (const auto& [x, z] :
         {std::array{1.5F, 2.0F}, {4.5F, 2.0F}, {6.1F, 1.5F}, {3.1F, 3.5F}, {7.0F, 1.5F}}) {
      EXPECT_FALSE(covers(rects, x, z)) << "room at " << x << ", " << z << ", cell " << cell;
    }
  }
}

TEST(RoomCut, FillsWallsBesideLooseSheets) {
  RenderSurface house = houseOfBoxes();
  // A curtain, and a picture before a wall.
  addQuad(house, {{{1, 0, 1}, {1, 0, 3}, {1, 2, 3}, {1, 2, 1}}});
  addQuad(house, {{{4, 1, 0.01F}, {5, 1, 0.01F}, {5, 2, 0.01F}, {4, 2, 0.01F}}});
  const auto rects = filledSection(sectionOf(house, 1.2F), 0.05);
  EXPECT_TRUE(covers(rects, -0.1F, 2));
  EXPECT_TRUE(covers(rects, 3.1F, 2));
  EXPECT_FALSE(covers(rects, 1.5F, 2));
  EXPECT_FALSE(covers(rects, 4.5F, 2));
}

TEST(RoomCut, OnlyOutlinesRoomsWhoseWallsAreSheets) {
  for (const Facing facing : {Facing::kIn, Facing::kOut}) {
    RenderSurface room;
    addBox(room, {{0, 0, 0}, {4, 2.5F, 3}}, facing);
    const auto section = sectionOf(room, 1.2F);
    EXPECT_EQ(section.size(), 8U);
    EXPECT_TRUE(filledSection(section, 0.05).empty());
  }
}

TEST(RoomCut, KeepsTheAreaBelowAndTellsTheOuterSide) {
  RenderSurface surface;
  addQuad(surface, {{{0, 0, 0}, {0, 0, -2}, {0, 2, -2}, {0, 2, 0}}});
  surface.vertices[2].color = surface.vertices[3].color = 0xFF000000;
  const auto section = sectionOf(surface, 0.5F);
  double area = 0;
  for (std::size_t n = 0; n < surface.corners.size(); n += 3) {
    const auto at = [&](std::size_t k) {
      return surface.vertices[surface.corners[n + k]].position;
    };
    const Vec3 normal = cross(at(1) - at(0), at(2) - at(0));
    EXPECT_GT(normal.x, 0);
    area += 0.5 * static_cast<double>(normal.x);
  }
  constexpr double kRounding = 1e-5;
  EXPECT_NEAR(area, 1, kRounding);
  ASSERT_EQ(section.size(), 2U);
  float length = 0;
  for (const SectionLine& line : section) {
    EXPECT_GT(line.to_z, line.from_z) << "the outer side is at higher x";
    length += line.to_z - line.from_z;
  }
  EXPECT_NEAR(length, 2, kRounding);
  // A quarter of the way from white to black.
  EXPECT_EQ(surface.vertices[surface.corners.back()].color & 0xFF, 0xBFU);
}

TEST(RoomCut, LeavesOutCeilingsBelowTheCut) {
  RenderSurface room;
  addBox(room, {{0, 0, 0}, {4, 2, 3}}, Facing::kIn);
  std::vector<SectionLine> section;
  cutThrough({2.5F, 1.5F}, room, section);
  EXPECT_TRUE(section.empty());
  // A floor and four walls.
  EXPECT_EQ(room.corners.size(), 5U * 6);
}

TEST(FloorPlanCut, LiesOverTheLowestLargeFloor) {
  RenderSurface house;
  // A cellar, a ground floor with a table, an upper floor, and the roof.
  addBox(house, {{0, -2, 0}, {2, 0, 2}}, Facing::kIn);
  addBox(house, {{0, 0, 0}, {8, 2.5F, 6}}, Facing::kIn);
  addBox(house, {{1, 0.7F, 1}, {3, 0.75F, 2}});
  addBox(house, {{0, 2.7F, 0}, {8, 5, 6}}, Facing::kIn);
  addBox(house, {{0, 2.6F, 0}, {8, 5.1F, 6}});
  constexpr float kStep = 0.11F;
  EXPECT_NEAR(floorPlanCut({&house, 1}).height, 1.2F, kStep);
}

TEST(FloorPlanCut, OfWallsAloneLiesOverTheirLowestPoint) {
  const RenderSurface house = houseOfBoxes();
  EXPECT_NEAR(floorPlanCut({&house, 1}).height, 1.2F, 0.01F);
}

TEST(FloorPlanCut, OfLowScenesLiesBelowTheirTops) {
  RenderSurface room;
  addBox(room, {{0, 0, 0}, {1, 0.5F, 1}}, Facing::kIn);
  EXPECT_NEAR(floorPlanCut({&room, 1}).height, 0.3F, 0.05F);
}

TEST(FilledSection, IsEmptyWhereThereIsTooMuchOrNothing) {
  EXPECT_TRUE(filledSection({}, 0.1).empty());
  const std::vector<SectionLine> far{{-1e30F, 0, 1e30F, 1}, {0, -1e30F, 1, 1e30F}};
  EXPECT_TRUE(filledSection(far, 1e-3).empty());
  const std::vector<SectionLine> point{{1, 1, 1, 1}};
  EXPECT_TRUE(filledSection(point, 0.1).empty());
}

}  // namespace
}  // namespace galactic::pictures::room_cut_test
