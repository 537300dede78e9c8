// Which spans are free space: rooms, outside and closed parts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "galactic/bake/column_engines.h"
#include "galactic/bake/columns.h"
#include "support/test_meshes.h"

namespace galactic::bake::free_space_test {
namespace {

using test::MeshBuilder;

constexpr std::uint32_t kSeed = 20250312;
constexpr float kSpacing = 0.03F;

Columns columnsOf(const TriangleMesh& mesh, float radius) {
  return exactColumns(mesh, makeGridFrame(mesh.bounds, radius, kSpacing).value()).columns;
}

/// Walls, floor and ceiling of a room, 10 cm thick, around the free box from min to max.
MeshBuilder& addRoom(MeshBuilder& builder, Vec3 min, Vec3 max, bool with_ceiling = true) {
  constexpr float kThick = 0.1F;
  const Vec3 lo{min.x - kThick, min.y - kThick, min.z - kThick};
  const Vec3 hi{max.x + kThick, max.y + kThick, max.z + kThick};
  builder.box(lo, {hi.x, min.y, hi.z});
  if (with_ceiling) builder.box({lo.x, max.y, lo.z}, hi);
  const float top = with_ceiling ? hi.y : max.y;
  builder.box(lo, {min.x, top, hi.z}).box({max.x, lo.y, lo.z}, {hi.x, top, hi.z});
  return builder.box(lo, {hi.x, top, min.z}).box({lo.x, lo.y, max.z}, {hi.x, top, hi.z});
}

/// Volume of a box that is given by its edges.
double volumeOf(double x, double y, double z) { return x * y * z; }

/// The most that counting whole columns changes the volume of a box: half a column on every side.
double oneCellLayer(double x, double y, double z) {
  const auto h = static_cast<double>(kSpacing);
  return y * ((x + h) * (z + h) - x * z);
}

const RegionTotals& totalsOf(const FreeSpace& free, Region region) {
  return free.totals[static_cast<std::size_t>(region)];
}

TEST(FreeSpace, OfAClosedRoomIsItsInsideLessTheRadius) {
  for (const float radius : {0.015F, 0.05F, 0.12F}) {
    SCOPED_TRACE(testing::Message() << "radius " << radius);
    MeshBuilder builder;
    const Columns columns = columnsOf(addRoom(builder, {0, 0, 0}, {6, 2.6F, 5}).build(), radius);
    const FreeSpace free = chooseFreeSpace(columns).value();
    const double r2 = 2 * static_cast<double>(radius);
    const RegionTotals& room = totalsOf(free, Region::kRoom);
    EXPECT_EQ(room.components, 1U);
    EXPECT_NEAR(room.volume, volumeOf(6 - r2, 2.6 - r2, 5 - r2),
                oneCellLayer(6 - r2, 2.6 - r2, 5 - r2));
    EXPECT_EQ(free.columns.spans.size(), room.spans);
    EXPECT_EQ(free.components.front().region, Region::kRoom);
    EXPECT_FALSE(free.components.front().touches_border);
    EXPECT_EQ(totalsOf(free, Region::kOutside).components, 1U);
  }
}

/// The volume of the outside is the frame's less that of the grown house.
TEST(FreeSpace, AddsUpEverySpanOnce) {
  MeshBuilder builder;
  const Columns columns = columnsOf(addRoom(builder, {0, 0, 0}, {3, 2.6F, 2}).build(), 0.05F);
  const FreeSpace free = chooseFreeSpace(columns).value();
  std::uint64_t spans = 0;
  std::uint32_t components = 0;
  double volume = 0;
  for (const RegionTotals& totals : free.totals) {
    spans += totals.spans;
    components += totals.components;
    volume += totals.volume;
  }
  double expected = 0;
  for (const Span& span : columns.spans) {
    expected += static_cast<double>(span.hi) - static_cast<double>(span.lo);
  }
  EXPECT_EQ(spans, columns.spans.size());
  EXPECT_EQ(components, free.components.size());
  EXPECT_NEAR(volume, expected * 0.03 * 0.03, 1e-6 * volume);
}

TEST(FreeSpace, OfARoomWithoutACeilingIsTheRoomAndTheSkyAboveIt) {
  MeshBuilder builder;
  const Columns columns =
      columnsOf(addRoom(builder, {0, 0, 0}, {6, 2.6F, 5}, false).build(), 0.05F);
  const FreeSpace free = chooseFreeSpace(columns).value();
  const Component& room = free.components.front();
  EXPECT_EQ(room.region, Region::kRoom);
  EXPECT_TRUE(room.touches_border);
  EXPECT_EQ(totalsOf(free, Region::kOutside).components, 0U);
  EXPECT_GT(room.volume, volumeOf(5.9, 2.5, 4.9));
  // The floor slab's inside is no room, although it alone touches no border.
  EXPECT_LT(static_cast<double>(room.bounds.min.y), 0.06);
}

/// Two rooms of one house with a wall between; `door` leaves an opening in it.
TriangleMesh twoRooms(bool door) {
  MeshBuilder builder;
  addRoom(builder, {0, 0, 0}, {5, 2.6F, 3});
  builder.box({2.95F, -0.05F, -0.05F}, {3.05F, 2.65F, door ? 1.0F : 3.05F});
  if (door) builder.box({2.95F, -0.05F, 2}, {3.05F, 2.65F, 3.05F});
  return builder.build();
}

TEST(FreeSpace, BehindAClosedDoorIsEnclosedUnlessItIsAskedFor) {
  const Columns columns = columnsOf(twoRooms(false), 0.05F);
  const double bigger = volumeOf(2.85, 2.5, 2.9);
  const double smaller = volumeOf(1.85, 2.5, 2.9);
  const FreeSpace one = chooseFreeSpace(columns).value();
  EXPECT_NEAR(totalsOf(one, Region::kRoom).volume, bigger, oneCellLayer(2.85, 2.5, 2.9));
  EXPECT_GT(totalsOf(one, Region::kEnclosed).volume, 0.9 * smaller);
  const FreeSpace two = chooseFreeSpace(columns, {.components = 2}).value();
  EXPECT_EQ(totalsOf(two, Region::kRoom).components, 2U);
  EXPECT_NEAR(totalsOf(two, Region::kRoom).volume, bigger + smaller,
              oneCellLayer(2.85, 2.5, 2.9) + oneCellLayer(1.85, 2.5, 2.9));
  const FreeSpace seeded =
      chooseFreeSpace(columns, {.seeds = {{1, 1, 1}, {4, 1, 1}, {4.5F, 2, 2}}}).value();
  EXPECT_EQ(seeded.columns.spans, two.columns.spans);
}

TEST(FreeSpace, BehindAnOpenDoorIsTheSameRoom) {
  const FreeSpace free = chooseFreeSpace(columnsOf(twoRooms(true), 0.05F)).value();
  EXPECT_EQ(totalsOf(free, Region::kRoom).components, 1U);
  EXPECT_GT(totalsOf(free, Region::kRoom).volume, volumeOf(4.7, 2.5, 2.9));
}

TEST(FreeSpace, OfASeedIsTheRoomThatItStandsInHoweverSmall) {
  const Columns columns = columnsOf(twoRooms(false), 0.05F);
  const FreeSpace free = chooseFreeSpace(columns, {.seeds = {{4, 1, 1}}}).value();
  EXPECT_NEAR(totalsOf(free, Region::kRoom).volume, volumeOf(1.85, 2.5, 2.9),
              oneCellLayer(1.85, 2.5, 2.9));
  for (const Component& part : free.components) {
    EXPECT_TRUE(part.region != Region::kRoom || part.bounds.min.x > 3.05F);
  }
}

/// Parts of the free space that are the room hold these points and no others.
void expectRoom(const TriangleMesh& mesh, const std::vector<Vec3>& in,
                const std::vector<Vec3>& out) {
  for (const float radius : {0.015F, 0.05F, 0.12F}) {
    SCOPED_TRACE(testing::Message() << "radius " << radius);
    const FreeSpace free = chooseFreeSpace(columnsOf(mesh, radius)).value();
    const auto is_kept = [&](const Vec3& at) {
      const GridFrame& frame = free.columns.frame;
      const auto i = static_cast<std::uint32_t>((at.x - frame.min_x) / frame.spacing);
      const auto k = static_cast<std::uint32_t>((at.z - frame.min_z) / frame.spacing);
      const auto spans = free.columns.column(free.columns.index(i, k));
      return std::ranges::any_of(
          spans, [&](const Span& span) { return span.lo <= at.y && at.y <= span.hi; });
    };
    for (const Vec3& at : in) EXPECT_TRUE(is_kept(at)) << at.x << " " << at.y << " " << at.z;
    for (const Vec3& at : out) EXPECT_FALSE(is_kept(at)) << at.x << " " << at.y << " " << at.z;
  }
}

TEST(FreeSpace, OfAClosedHouseInAGardenIsTheHouse) {
  MeshBuilder builder;
  addRoom(builder, {0, 0, 0}, {5, 2.5F, 4}).box({-12, -0.3F, -13}, {17, -0.1F, 14});
  const TriangleMesh mesh = builder.build();
  expectRoom(mesh, {{1, 1, 1}, {4.7F, 0.3F, 3.7F}}, {{-5, 1, 3}, {10, 0.5F, 1}});
  const FreeSpace free = chooseFreeSpace(columnsOf(mesh, 0.05F)).value();
  const auto& house = *std::ranges::find(free.components, Region::kRoom, &Component::region);
  // Where squares of 80 cm find room for their middles.
  EXPECT_NEAR(house.floor, 4.2 * 3.2, 0.5);
  EXPECT_EQ(house.yard, 0);
  const auto& garden = *std::ranges::find(free.components, Region::kOutside, &Component::region);
  EXPECT_EQ(garden.floor, 0);
  EXPECT_NEAR(garden.yard, 28.38 * 26.38 - 6.02 * 5.02, 2);
}

TEST(FreeSpace, OfAWalledRoomWithoutACeilingIsFloorAndNoYard) {
  MeshBuilder builder;
  addRoom(builder, {0, 0, 0}, {5, 2.5F, 4}, false);
  const FreeSpace free = chooseFreeSpace(columnsOf(builder.build(), 0.05F)).value();
  const auto& room = *std::ranges::find(free.components, Region::kRoom, &Component::region);
  EXPECT_NEAR(room.floor, 4.2 * 3.2, 0.5);
  EXPECT_EQ(room.yard, 0);
}

TEST(FreeSpace, OfASmallHouseInAGardenIsTheHouseForAllRadii) {
  MeshBuilder builder;
  addRoom(builder, {0, 0, 0}, {3, 2.5F, 3}).box({-4, -0.3F, -4}, {7, -0.1F, 7});
  const TriangleMesh mesh = builder.build();
  expectRoom(mesh, {{1, 1, 1}}, {{-2, 1, 1}});
  // What there is of it for large spheres is no room by itself, but it is where the room is.
  const FreeSpace room = chooseFreeSpace(columnsOf(mesh, 0.015F)).value();
  const Columns columns = columnsOf(mesh, 0.8F);
  const FreeSpace inside = chooseFreeSpace(columns, {}, &room.columns).value();
  EXPECT_NEAR(totalsOf(inside, Region::kRoom).volume, volumeOf(1.4, 0.9, 1.4),
              oneCellLayer(1.4, 0.9, 1.4));
  EXPECT_EQ(totalsOf(inside, Region::kOutside).components, 1U);
  // And where no ball fits into it, there is none.
  const FreeSpace none = chooseFreeSpace(columnsOf(mesh, 1.3F), {}, &room.columns).value();
  EXPECT_TRUE(none.columns.spans.empty());
}

TEST(FreeSpace, OfAHouseWithAGapIsClosedForSpheresThatDoNotPassIt) {
  MeshBuilder builder;
  addRoom(builder, {0, 0, 0}, {5, 2.5F, 4}, false);
  builder.box({-0.1F, 2.5F, -0.1F}, {5.1F, 2.6F, 3.9F}).box({-4, -0.3F, -4}, {9, -0.1F, 9});
  const TriangleMesh mesh = builder.build();
  const FreeSpace wide = chooseFreeSpace(columnsOf(mesh, 0.02F)).value();
  EXPECT_EQ(totalsOf(wide, Region::kOutside).components, 0U);
  const FreeSpace closed = chooseFreeSpace(columnsOf(mesh, 0.12F), {}, &wide.columns).value();
  EXPECT_EQ(totalsOf(closed, Region::kOutside).components, 1U);
  EXPECT_NEAR(totalsOf(closed, Region::kRoom).volume, volumeOf(4.76, 2.26, 3.76), 3);
}

TEST(FreeSpace, OfAClosedRoomThatStandsAcrossIsItsInside) {
  // Turned about Y, with a chimney: the scene's bounds hold more of the outside than of the room.
  MeshBuilder builder;
  addRoom(builder, {0, 0, 0}, {5, 2.5F, 4}).box({1, 2.6F, 1}, {1.5F, 4, 1.5F});
  TriangleMesh mesh = builder.build();
  const float half = std::sqrt(0.5F);
  mesh.bounds = {{9, 9, 9}, {-9, -9, -9}};
  for (Vec3& p : mesh.vertices) {
    p = {half * (p.x + p.z), p.y, half * (p.z - p.x)};
    Bounds& bounds = mesh.bounds;
    bounds.min = {std::min(bounds.min.x, p.x), std::min(bounds.min.y, p.y),
                  std::min(bounds.min.z, p.z)};
    bounds.max = {std::max(bounds.max.x, p.x), std::max(bounds.max.y, p.y),
                  std::max(bounds.max.z, p.z)};
  }
  expectRoom(mesh, {{half * 5, 1, -half}}, {{0.3F, 1, 2}});
}

TEST(FreeSpace, OfAHouseWithoutCeilingsIsNeitherWallsNorWardrobes) {
  MeshBuilder builder;
  // Walls as thick as 60 cm, hollow as all boxes are, and a large wardrobe.
  builder.box({0, -0.2F, 0}, {8, 0, 6})
      .box({0, 0, 0}, {8, 2.6F, 0.6F})
      .box({0, 0, 5.4F}, {8, 2.6F, 6});
  builder.box({0, 0, 0.6F}, {0.6F, 2.6F, 5.4F}).box({7.4F, 0, 0.6F}, {8, 2.6F, 5.4F});
  builder.box({2, 0, 0.65F}, {6, 2.3F, 1.35F});
  expectRoom(builder.build(), {{4, 1, 3}}, {{0.3F, 1, 3}, {4, 1, 1}});
}

TEST(FreeSpace, OfAHouseWithOpenDoorsIsMoreThanItsClosedBath) {
  // The bath is behind a closed door, and the way out through an open one.
  MeshBuilder open;
  open.box({0, -0.1F, 0}, {9, 0, 6}).box({0, 2.5F, 0}, {9, 2.6F, 6});
  open.box({-0.1F, 0, 0}, {0, 2.5F, 6}).box({9, 0, 0}, {9.1F, 2.5F, 6});
  open.box({0, 0, 6}, {9, 2.5F, 6.1F})
      .box({0, 0, -0.1F}, {2, 2.5F, 0})
      .box({3, 0, -0.1F}, {9, 2.5F, 0});
  open.box({5.5F, 0, -0.1F}, {5.6F, 2.5F, 6.1F});
  expectRoom(open.build(), {{1, 1, 3}}, {{7, 1, 3}});
}

TEST(FreeSpace, OfAFloorAloneIsWhatIsAboveIt) {
  MeshBuilder builder;
  builder.box({0, 0, 0}, {5, 0.1F, 4});
  for (const float radius : {0.015F, 0.05F}) {
    const FreeSpace free = chooseFreeSpace(columnsOf(builder.build(), radius)).value();
    const auto& room = *std::ranges::find(free.components, Region::kRoom, &Component::region);
    EXPECT_TRUE(room.touches_border) << "radius " << radius;
  }
}

TEST(FreeSpace, OfAFloorWithoutThicknessIsTheSameForAllRadii) {
  MeshBuilder builder;
  builder.floor({0, 0, 0}, {5, 0, 4}, 0);
  const TriangleMesh mesh = builder.build();
  const FreeSpace room = chooseFreeSpace(columnsOf(mesh, 0.015F)).value();
  EXPECT_FALSE(room.columns.spans.empty());
  for (const float radius : {0.05F, 0.12F, 1.0F}) {
    const Columns columns = columnsOf(mesh, radius);
    const FreeSpace free = chooseFreeSpace(columns, {}, &room.columns).value();
    EXPECT_EQ(free.columns.spans.size(), columns.spans.size()) << "radius " << radius;
  }
}

/// A room, a closed cabinet in it, and a closed chest in the cabinet.
TriangleMesh nestedBoxes() {
  MeshBuilder builder;
  addRoom(builder, {0, 0, 0}, {5, 2.6F, 4});
  builder.box({1, -0.05F, 1}, {2.2F, 1.8F, 2});
  builder.box({1.3F, 0.4F, 1.3F}, {1.9F, 1, 1.7F});
  return builder.build();
}

TEST(FreeSpace, InsideASealedCabinetIsEnclosedAndSoIsAChestInIt) {
  const Columns columns = columnsOf(nestedBoxes(), 0.05F);
  const FreeSpace free = chooseFreeSpace(columns).value();
  std::vector<double> inside;
  for (const Component& part : free.components) {
    const bool in_cabinet = part.bounds.min.x > 1 && part.bounds.max.x < 2.2F &&
                            part.bounds.min.z > 1 && part.bounds.max.z < 2;
    if (!in_cabinet) continue;
    EXPECT_EQ(part.region, Region::kEnclosed);
    inside.push_back(part.volume);
  }
  ASSERT_EQ(inside.size(), 2U);
  // The cabinet stands 5 cm deep in the floor, whose top face ends it at the radius.
  const double chest = volumeOf(0.5, 0.5, 0.3);
  EXPECT_NEAR(inside[1], chest, oneCellLayer(0.5, 0.5, 0.3));
  const double cabinet = volumeOf(1.1, 1.7, 0.9) - volumeOf(0.7, 0.7, 0.5);
  EXPECT_NEAR(inside[0], cabinet, oneCellLayer(1.1, 1.7, 0.9) + oneCellLayer(0.7, 0.7, 0.5));
}

TEST(FreeSpace, KeepsAllSpansWhenAsked) {
  const Columns columns = columnsOf(nestedBoxes(), 0.05F);
  const FreeSpace free = chooseFreeSpace(columns, {.keep = Keep::kAll}).value();
  EXPECT_EQ(free.columns.spans, columns.spans);
  EXPECT_EQ(free.columns.first, columns.first);
  EXPECT_EQ(totalsOf(free, Region::kRoom).components, 1U);
  EXPECT_LT(totalsOf(free, Region::kRoom).spans, columns.spans.size());
}

/// The error of seeds that must not be accepted.
Error seedError(const Columns& columns, Vec3 seed) {
  const auto free = chooseFreeSpace(columns, {.seeds = {seed}});
  EXPECT_FALSE(free);
  return free ? Error{} : free.error();
}

TEST(FreeSpace, RefusesASeedInsideAnObstacleAndNamesTheFreeHeights) {
  MeshBuilder builder;
  const Columns columns = columnsOf(addRoom(builder, {0, 0, 0}, {3, 2.6F, 2}).build(), 0.05F);
  const Error error = seedError(columns, {1.5F, 0.02F, 1});
  EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
  EXPECT_EQ(error.where, "`inside`");
  EXPECT_EQ(error.message,
            "(1.5, 0.02, 1) is blocked (free there: -0.160 to -0.150 m, 0.050 to 2.550 m, "
            "2.750 to 2.760 m) for radius 0.05 m; give a point where a sphere of that radius fits, "
            "in meters with y up");
}

TEST(FreeSpace, RefusesASeedInAColumnWithoutFreeHeights) {
  Columns columns;
  columns.frame.radius = 0.05F;
  columns.frame.spacing = 1;
  columns.frame.heights = {0, 2};
  columns.frame.columns_x = columns.frame.columns_z = 3;
  columns.first.assign(10, 0);
  EXPECT_EQ(seedError(columns, {1.5F, 1, 1.5F}).message,
            "(1.5, 1, 1.5) is blocked for radius 0.05 m; give a point where a sphere of that "
            "radius fits, in meters with y up");
}

TEST(FreeSpace, RefusesASeedOutsideTheGrid) {
  MeshBuilder builder;
  const Columns columns = columnsOf(addRoom(builder, {0, 0, 0}, {3, 2.6F, 2}).build(), 0.05F);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Vec3 seed : {Vec3{-9, 1, 1}, {1, 1, 77}, {1e30F, 1, 1}, {nan, 1, 1}, {1, 1, nan}}) {
    const Error error = seedError(columns, seed);
    EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
    EXPECT_THAT(error.message, testing::HasSubstr("is outside the scene for radius 0.05 m"));
  }
  // In the margin of the grid about the walls, some of which the walls block.
  for (const float out : {0.06F, 0.09F}) {
    for (const Vec3 seed : {Vec3{-out, 1, 1}, {3 + out, 1, 1}, {1, 1, -out}, {1, 1, 2 + out}}) {
      EXPECT_EQ(seedError(columns, seed).code, ErrorCode::kInvalidInput);
    }
  }
  // Above the roof the grid knows nothing, and says where it does.
  EXPECT_THAT(seedError(columns, {1, 50, 1}).message, testing::HasSubstr("is blocked (free there"));
  EXPECT_THAT(seedError(columns, {1, nan, 1}).message,
              testing::HasSubstr("is blocked (free there"));
}

TEST(FreeSpace, OfNothingIsNothing) {
  Columns columns;
  columns.frame.spacing = 1;
  columns.frame.columns_x = columns.frame.columns_z = 2;
  columns.first = {0, 0, 0, 0, 0};
  const FreeSpace free = chooseFreeSpace(columns, {.components = 5}).value();
  EXPECT_TRUE(free.components.empty());
  EXPECT_EQ(free.columns.first, columns.first);
}

/// A single closed sheet, tilted and turned, parts the space for any radius from half the spacing.
TEST(FreeSpace, DoesNotLeakThroughAClosedSheetAtHalfTheSpacing) {
  for (int turn = 0; turn < 24; ++turn) {
    // A cube of sheets without thickness, turned about two axes.
    const double yaw = 0.1309 * turn;
    const double pitch = 0.07 * turn;
    const auto turned = [&](double x, double y, double z) {
      const double x1 = x * std::cos(yaw) + z * std::sin(yaw);
      const double z1 = -x * std::sin(yaw) + z * std::cos(yaw);
      return Vec3{static_cast<float>(x1 * std::cos(pitch) - y * std::sin(pitch)),
                  static_cast<float>(x1 * std::sin(pitch) + y * std::cos(pitch)),
                  static_cast<float>(z1)};
    };
    MeshBuilder builder;
    for (const double side : {-0.5, 0.5}) {
      builder.quad({turned(side, -0.5, -0.5), turned(side, -0.5, 0.5), turned(side, 0.5, 0.5),
                    turned(side, 0.5, -0.5)});
      builder.quad({turned(-0.5, side, -0.5), turned(-0.5, side, 0.5), turned(0.5, side, 0.5),
                    turned(0.5, side, -0.5)});
      builder.quad({turned(-0.5, -0.5, side), turned(-0.5, 0.5, side), turned(0.5, 0.5, side),
                    turned(0.5, -0.5, side)});
    }
    const Columns columns = columnsOf(builder.build(), kSpacing / 2);
    const FreeSpace free = chooseFreeSpace(columns, {.seeds = {{0, 0, 0}}}).value();
    EXPECT_FALSE(free.components[0].region == Region::kRoom && free.components[0].touches_border)
        << "turn " << turn;
    EXPECT_LT(totalsOf(free, Region::kRoom).volume, 1.0) << "turn " << turn;
    EXPECT_GT(totalsOf(free, Region::kRoom).volume, 0.85) << "turn " << turn;
  }
}

/// Components by breadth-first search over pairs of spans, each with its column.
class Search {
 public:
  explicit Search(const Columns& columns) : columns_(columns), label_(columns.spans.size(), -1) {
    for (std::size_t at = 0; at < columns.frame.columnCount(); ++at) {
      for (std::uint32_t s = columns.first[at]; s < columns.first[at + 1]; ++s) {
        if (label_[s] >= 0) continue;
        spread(at, s);
        ++count_;
      }
    }
  }

  [[nodiscard]] const std::vector<int>& labels() const { return label_; }
  [[nodiscard]] int count() const { return count_; }

 private:
  struct Place {
    std::size_t column = 0;
    std::uint32_t span = 0;
  };

  void spread(std::size_t column, std::uint32_t span) {
    std::deque<Place> open{{column, span}};
    label_[span] = count_;
    const std::size_t nx = columns_.frame.columns_x;
    while (!open.empty()) {
      const Place here = open.front();
      open.pop_front();
      const std::size_t i = here.column % nx;
      const std::size_t k = here.column / nx;
      if (i > 0) visit(here, here.column - 1, open);
      if (i + 1 < nx) visit(here, here.column + 1, open);
      if (k > 0) visit(here, here.column - nx, open);
      if (k + 1 < columns_.frame.columns_z) visit(here, here.column + nx, open);
    }
  }

  void visit(const Place& here, std::size_t column, std::deque<Place>& open) {
    const Span& a = columns_.spans[here.span];
    for (std::uint32_t s = columns_.first[column]; s < columns_.first[column + 1]; ++s) {
      const Span& b = columns_.spans[s];
      if (label_[s] >= 0 || !(a.lo < b.hi && b.lo < a.hi)) continue;
      label_[s] = count_;
      open.push_back({column, s});
    }
  }

  const Columns& columns_;
  std::vector<int> label_;
  int count_ = 0;
};

/// Small grids of random spans on whole heights, so that spans often end exactly where others
/// begin.
Columns randomColumns(std::mt19937& random) {
  Columns columns;
  columns.frame.spacing = 0.5F;
  columns.frame.heights = {0, 24};
  columns.frame.columns_x = 2 + static_cast<std::uint32_t>(random() % 12);
  columns.frame.columns_z = 2 + static_cast<std::uint32_t>(random() % 12);
  columns.first.push_back(0);
  for (std::size_t at = 0; at < columns.frame.columnCount(); ++at) {
    std::set<int> ends;
    const std::size_t wanted = 2 * (random() % 5);
    while (ends.size() < wanted) ends.insert(static_cast<int>(random() % 25));
    for (auto end = ends.begin(); end != ends.end(); ++end) {
      const auto lo = static_cast<float>(*end);
      columns.spans.push_back({lo, static_cast<float>(*++end)});
    }
    columns.first.push_back(static_cast<std::uint32_t>(columns.spans.size()));
  }
  return columns;
}

/// Volumes of the components within the frame without its padding: the radius and a cell in the
/// plane, the radius and 1 cm in height.
std::vector<double> volumesInside(const Columns& columns, const Search& search) {
  const GridFrame& frame = columns.frame;
  std::vector<double> volumes(static_cast<std::size_t>(search.count()), 0);
  const Bounds scene = sceneBounds(frame);
  for (std::uint32_t k = 0; k < frame.columns_z; ++k) {
    for (std::uint32_t i = 0; i < frame.columns_x; ++i) {
      const auto x = static_cast<float>(frame.centerX(i));
      const auto z = static_cast<float>(frame.centerZ(k));
      if (x < scene.min.x || x > scene.max.x || z < scene.min.z || z > scene.max.z) continue;
      const std::size_t at = columns.index(i, k);
      for (std::uint32_t s = columns.first[at]; s < columns.first[at + 1]; ++s) {
        const double lo = static_cast<double>(std::max(columns.spans[s].lo, scene.min.y));
        const double hi = static_cast<double>(std::min(columns.spans[s].hi, scene.max.y));
        volumes[static_cast<std::size_t>(search.labels()[s])] += 0.25 * std::max(0.0, hi - lo);
      }
    }
  }
  return volumes;
}

TEST(FreeSpace, IsTheRoomThoughThePaddingAroundItHoldsMore) {
  // A closed room of one meter, and spheres so big that the padding is wider than the room.
  const TriangleMesh mesh = test::MeshBuilder().box({-0.5F, 0, -0.5F}, {0.5F, 1, 0.5F}).build();
  const GridFrame frame = makeGridFrame(mesh.bounds, 0.3F, 0.1F).value();
  const FreeSpace free = chooseFreeSpace(exactColumns(mesh, frame).columns).value();
  ASSERT_EQ(free.components.size(), 2U);
  EXPECT_EQ(free.components[0].region, Region::kOutside);
  EXPECT_EQ(free.components[1].region, Region::kRoom);
  EXPECT_GT(free.components[0].volume, free.components[1].volume);
  EXPECT_NEAR(free.components[1].volume, 0.4 * 0.4 * 0.4, 0.03);
}

TEST(FreeSpace, EqualsABreadthFirstSearchOnRandomColumns) {
  RecordProperty("seed", static_cast<int>(kSeed));
  std::mt19937 random(kSeed);
  std::size_t kept = 0;
  std::size_t all = 0;
  for (int round = 0; round < 400; ++round) {
    const Columns columns = randomColumns(random);
    const Search search(columns);
    std::vector<double> volume(static_cast<std::size_t>(search.count()), 0);
    for (std::size_t s = 0; s < columns.spans.size(); ++s) {
      volume[static_cast<std::size_t>(search.labels()[s])] +=
          0.25 * static_cast<double>(columns.spans[s].hi - columns.spans[s].lo);
    }
    // The first of the greatest components, first by what lies within the scene's bounds; the
    // labels are in the order of their first spans.
    const std::vector<double> inside = volumesInside(columns, search);
    std::size_t greatest = 0;
    for (std::size_t n = 1; n < volume.size(); ++n) {
      if (std::pair(inside[n], volume[n]) > std::pair(inside[greatest], volume[greatest])) {
        greatest = n;
      }
    }
    std::vector<Span> expected;
    for (std::size_t s = 0; s < columns.spans.size(); ++s) {
      if (search.labels()[s] == static_cast<int>(greatest)) expected.push_back(columns.spans[s]);
    }
    const FreeSpace free = chooseFreeSpace(columns).value();
    ASSERT_EQ(free.columns.spans, expected) << "seed " << kSeed << ", round " << round;
    ASSERT_EQ(free.components.size(), volume.size());
    std::sort(volume.rbegin(), volume.rend());
    for (std::size_t n = 0; n < volume.size(); ++n) {
      ASSERT_DOUBLE_EQ(free.components[n].volume, volume[n]);
    }
    kept += expected.size();
    all += columns.spans.size();
  }
  EXPECT_GT(kept, all / 10);
  EXPECT_LT(kept, all * 9 / 10);
}

}  // namespace
}  // namespace galactic::bake::free_space_test
