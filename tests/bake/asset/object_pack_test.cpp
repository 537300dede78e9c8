#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "galactic/bake/packs.h"
#include "galactic/object_set.h"
#include "galactic/pack.h"
#include "support/packs/pack_parts.h"
#include "support/scratch_folder.h"
#include "support/source_asset.h"
#include "support/test_meshes.h"

namespace galactic::test::object_pack_test {
namespace {

using bake::BakedObjectSet;
using bake::encodeObjectPack;

bake::ObjectBakeOptions coarse() {
  bake::ObjectBakeOptions options;
  options.spheres.radii = {0.015F, 0.03F};
  options.spheres.eps = 0.02F;
  options.spheres.tau = 0.03F;
  return options;
}

bake::BakedObject bakeBox(const std::string& name, Vec3 size, unsigned threads = 1) {
  auto object = bakeObject(sourceAssetOf(MeshBuilder().box({0, 0, 0}, size).build(), name),
                           coarse(), threads);
  EXPECT_TRUE(object.has_value());
  return object ? std::move(*object) : bake::BakedObject{};
}

BakedObjectSet threeBoxes(unsigned threads = 1) {
  BakedObjectSet set;
  set.radii = coarse().spheres.radii;
  set.objects = {bakeBox("mug", {0.06F, 0.08F, 0.06F}, threads),
                 bakeBox("book", {0.1F, 0.02F, 0.07F}, threads),
                 bakeBox("Zebra", {0.05F, 0.05F, 0.05F}, threads)};
  return set;
}

bake::Provenance provenance() {
  bake::Provenance made;
  made.tool_version = "0.1.0";
  made.sources.push_back({.name = "mug.obj", .bytes = 12, .hash_low = 1, .hash_high = 2});
  return made;
}

TEST(ObjectPack, OpensAndShowsTheObjectsByAscendingName) {
  const BakedObjectSet set = threeBoxes();
  const auto payload = encodeObjectPack(set, provenance());
  ASSERT_TRUE(payload.has_value());
  const AlignedBytes bytes = packFile(PackKind::kObjects, *payload);
  const auto pack = PackFile::view(bytes.bytes(), "boxes.pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().text();
  const auto opened = ObjectSet::from(*pack);
  ASSERT_TRUE(opened.has_value());
  ASSERT_EQ(opened->objects().size(), 3U);
  const std::vector<std::size_t> order{2, 1, 0};
  for (std::size_t n = 0; n < 3; ++n) {
    const bake::BakedObject& baked = set.objects[order[n]];
    const ObjectModel& object = opened->objects()[n];
    EXPECT_EQ(object.name, baked.name);
    EXPECT_EQ(object.box, baked.box.box);
    EXPECT_EQ(std::vector(object.spheres.begin(), object.spheres.end()), baked.spheres.spheres);
    EXPECT_EQ(std::vector(object.stable_poses.begin(), object.stable_poses.end()),
              baked.stable_poses);
  }
}

TEST(ObjectPack, OpensWithAnObjectAsFarAwayAsPossible) {
  BakedObjectSet set;
  set.radii = coarse().spheres.radii;
  auto object = bakeObject(
      sourceAssetOf(MeshBuilder().box({799, -799, 799}, {799.5F, -798.5F, 799.25F}).build(), "far"),
      coarse());
  ASSERT_TRUE(object) << object.error().text();
  set.objects = {std::move(*object)};
  const auto payload = encodeObjectPack(set, provenance());
  ASSERT_TRUE(payload) << payload.error().text();
  const AlignedBytes bytes = packFile(PackKind::kObjects, *payload);
  const auto pack = PackFile::view(bytes.bytes(), "far.pack");
  ASSERT_TRUE(pack) << pack.error().text();
  const auto opened = ObjectSet::from(*pack);
  EXPECT_TRUE(opened) << opened.error().text();
}

TEST(ObjectPack, HasTheSameBytesForAnyOrderOfObjectsAndAnyNumberOfJobs) {
  const auto first = encodeObjectPack(threeBoxes(1), provenance());
  BakedObjectSet turned = threeBoxes(3);
  std::reverse(turned.objects.begin(), turned.objects.end());
  const auto second = encodeObjectPack(turned, provenance());
  ASSERT_TRUE(first.has_value() && second.has_value());
  EXPECT_TRUE(*first == *second);
}

TEST(ObjectPack, RefusesTwoObjectsOfOneName) {
  BakedObjectSet set = threeBoxes();
  set.objects[2].name = "mug";
  const auto payload = encodeObjectPack(set, provenance());
  ASSERT_FALSE(payload.has_value());
  EXPECT_EQ(payload.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(payload.error().where, "mug");
  EXPECT_EQ(payload.error().message,
            "is the name of two objects; rename one of the files or folders");
}

TEST(ObjectPack, RefusesNoObjectsAndNoName) {
  auto payload = encodeObjectPack({}, provenance());
  ASSERT_FALSE(payload.has_value());
  EXPECT_EQ(payload.error().message, "there are no objects for the pack; give some");
  BakedObjectSet set = threeBoxes();
  set.objects[1].name.clear();
  payload = encodeObjectPack(set, provenance());
  ASSERT_FALSE(payload.has_value());
  EXPECT_EQ(payload.error().message, "an object has no name; give it one");
}

TEST(ObjectPack, IsWrittenWithItsHeader) {
  const ScratchFolder folder;
  const auto path = folder.path() / "boxes.pack";
  const auto bytes = writeObjectPack(path, threeBoxes(), provenance());
  ASSERT_TRUE(bytes.has_value());
  EXPECT_EQ(*bytes, std::filesystem::file_size(path));
  const auto pack = PackFile::open(path);
  ASSERT_TRUE(pack.has_value()) << pack.error().message;
  EXPECT_EQ(pack->kind(), PackKind::kObjects);
  EXPECT_FALSE(writeObjectPack(path, {}, provenance()).has_value());
  EXPECT_EQ(std::filesystem::file_size(path), *bytes) << "the old pack stays";
}

}  // namespace
}  // namespace galactic::test::object_pack_test
