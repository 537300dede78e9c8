#include "galactic/object_set.h"

#include <gtest/gtest.h>

#include "support/packs/object_pack_builder.h"
#include "support/packs/robot_pack_builder.h"

namespace galactic::test::object_set_test {
namespace {

TEST(ObjectSet, ShowsWhatThePackHolds) {
  const ObjectPackFields fields = smallObjects();
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "objects.pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().message;
  const Result<ObjectSet> set = ObjectSet::from(*pack);
  ASSERT_TRUE(set.has_value()) << set.error().message;
  ASSERT_EQ(set->radii().size(), 2U);
  EXPECT_EQ(set->radii()[1], 0.05F);
  ASSERT_EQ(set->objects().size(), fields.objects.size());
  for (std::size_t n = 0; n < fields.objects.size(); ++n) {
    const ObjectFields& made = fields.objects[n];
    const ObjectModel& object = set->objects()[n];
    EXPECT_EQ(object.name, made.name);
    EXPECT_EQ(object.box, (OrientedBox{*made.box_pose, *made.box_half_extents}));
    EXPECT_EQ(std::vector(object.spheres.begin(), object.spheres.end()), made.spheres);
    EXPECT_EQ(std::vector(object.stable_poses.begin(), object.stable_poses.end()),
              made.stable_poses);
    EXPECT_TRUE(object.hull_planes.empty()) << "an older pack has none";
  }
}

TEST(ObjectSet, ShowsThePlanesAroundHulls) {
  ObjectPackFields fields = smallObjects();
  fields.objects[1].hull_planes = {{{0, 1, 0}, 0.1F}, {{0.6F, 0, -0.8F}, -0.2F}};
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "objects.pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().message;
  const Result<ObjectSet> set = ObjectSet::from(*pack);
  ASSERT_TRUE(set.has_value()) << set.error().message;
  const ObjectModel& object = set->objects()[1];
  EXPECT_EQ(std::vector(object.hull_planes.begin(), object.hull_planes.end()),
            fields.objects[1].hull_planes);
}

TEST(ObjectSet, PointsIntoThePackWithoutCopying) {
  const AlignedBytes bytes = buildPack(smallObjects());
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "objects.pack");
  ASSERT_TRUE(pack.has_value());
  const Result<ObjectSet> set = ObjectSet::from(*pack);
  ASSERT_TRUE(set.has_value());
  const auto inside = [&](const void* address) {
    const auto* byte = static_cast<const std::byte*>(address);
    return byte >= bytes.bytes().data() && byte < bytes.bytes().data() + bytes.size();
  };
  for (const ObjectModel& object : set->objects()) {
    EXPECT_TRUE(inside(object.spheres.data()));
    EXPECT_TRUE(inside(object.stable_poses.data()));
    EXPECT_TRUE(inside(object.name.data()));
  }
}

TEST(ObjectSet, FindsEachObjectByItsNameAndNoOther) {
  ObjectPackFields fields;
  for (const char* name : {"apple", "bowl", "mug", "spoon", "\xc3\xa9tui"}) {
    fields.objects.emplace_back().name = name;
  }
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "objects.pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().message;
  const Result<ObjectSet> set = ObjectSet::from(*pack);
  ASSERT_TRUE(set.has_value());
  for (std::size_t n = 0; n < fields.objects.size(); ++n) {
    EXPECT_EQ(set->find(fields.objects[n].name), n);
  }
  for (const char* name : {"", "a", "apples", "bow", "zebra", "\xff"}) {
    EXPECT_EQ(set->find(name), std::nullopt) << name;
  }
}

TEST(ObjectSet, RefusesAPackOfAnotherKind) {
  const AlignedBytes bytes = buildPack(smallRobotPack());
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "helper.pack");
  ASSERT_TRUE(pack.has_value());
  const Result<ObjectSet> set = ObjectSet::from(*pack);
  ASSERT_FALSE(set.has_value());
  EXPECT_EQ(set.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(set.error().where, "helper.pack");
  EXPECT_EQ(set.error().message,
            "is a pack of kind RBOT, expected objects (OBJS); give the pack of an object set");
}

TEST(ObjectSet, RefusesATrustedPackWhoseHeaderLies) {
  RobotPackFields fields = smallRobotPack();
  fields.kind = PackKind::kObjects;
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "helper.pack", Trust::kTrusted);
  ASSERT_TRUE(pack.has_value());
  EXPECT_FALSE(ObjectSet::from(*pack).has_value());
}

}  // namespace
}  // namespace galactic::test::object_set_test
