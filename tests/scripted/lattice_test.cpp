// Lattices over floors, cut where they are too large.
#include "scripted/lattice.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <optional>

namespace galactic::test::lattice_test {
namespace {

using scripted::GroundArea;
using scripted::Lattice;
using scripted::layOut;

constexpr float kEdge = 0.1F;
constexpr GroundArea kHall{-10, 10, -20, 20};
constexpr GroundArea kCorner{-10, -7, 15, 17};

TEST(Lattice, HasThePlacesOfTheWholeFloorWhereTheyAreFewEnough) {
  const std::optional<Lattice> lattice = layOut(kHall, kCorner, kEdge, 201 * 401);
  ASSERT_TRUE(lattice);
  EXPECT_EQ(lattice->cells(), 201U * 401U);
  for (const Vec3& place : {Vec3{-10, 0, -20}, Vec3{10, 0, 20}, Vec3{0.3F, 0, -7.1F}}) {
    const std::optional<std::uint32_t> cell = lattice->cellAt(place.x, place.z);
    ASSERT_TRUE(cell);
    const Vec3 away = lattice->placeOf(*cell) - place;
    EXPECT_LT(dot(away, away), 1e-9F);
  }
  EXPECT_FALSE(lattice->cellAt(10.1F, 0));
  EXPECT_FALSE(lattice->cellAt(0, -20.1F));
}

TEST(Lattice, IsCutToAsMuchAsMayBeAroundAPart) {
  std::size_t before = 0;
  for (const std::size_t most : {1000U, 5000U, 20000U, 60000U}) {
    const std::optional<Lattice> lattice = layOut(kHall, kCorner, kEdge, most);
    ASSERT_TRUE(lattice);
    EXPECT_LE(lattice->cells(), most);
    // A row on each side, and the wall that it does not go beyond.
    EXPECT_GT(lattice->cells() + 2 * (201 + 401), most);
    EXPECT_GT(lattice->cells(), before);
    before = lattice->cells();
    EXPECT_TRUE(lattice->cellAt(-10, 15));
    EXPECT_TRUE(lattice->cellAt(-7, 17));
    EXPECT_FALSE(lattice->cellAt(-10.2F, 15));
  }
}

TEST(Lattice, IsNoneWhereThePartIsTooLarge) {
  EXPECT_FALSE(layOut(kHall, kCorner, kEdge, 500));
  EXPECT_FALSE(layOut(kHall, kHall, kEdge, 50000));
  // A part that lies elsewhere has no cells.
  const std::optional<Lattice> lattice = layOut(kHall, {30, 31, 30, 31}, kEdge, 500);
  ASSERT_TRUE(lattice);
  EXPECT_LE(lattice->cells(), 500U);
}

}  // namespace
}  // namespace galactic::test::lattice_test
