// What the header says is inside, and what is: each kind of asset under the header of each other.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "galactic/pack.h"
#include "support/packs/episode_pack_builder.h"
#include "support/packs/object_pack_builder.h"
#include "support/packs/policy_pack_builder.h"
#include "support/packs/robot_pack_builder.h"
#include "support/packs/scene_pack_builder.h"
#include "support/packs/texture_pack_builder.h"
#include "support/packs/world_pack_builder.h"

namespace galactic::test::pack_kind_test {
namespace {

constexpr std::array kKinds{PackKind::kScene,    PackKind::kObjects, PackKind::kRobot,
                            PackKind::kEpisodes, PackKind::kWorld,   PackKind::kTexture,
                            PackKind::kPolicy};

template <class Fields>
AlignedBytes under(PackKind header, Fields fields) {
  fields.kind = header;
  return buildPack(fields);
}

/// A valid pack of `kind` but for its header, which says that it is of another.
AlignedBytes packUnder(PackKind header, PackKind kind) {
  switch (kind) {
    case PackKind::kScene:
      break;
    case PackKind::kObjects:
      return under(header, smallObjects());
    case PackKind::kRobot:
      return under(header, smallRobotPack());
    case PackKind::kEpisodes:
      return under(header, smallEpisodes());
    case PackKind::kWorld:
      return under(header, smallWorldPack());
    case PackKind::kTexture:
      return under(header, TexturePackFields{});
    case PackKind::kPolicy:
      return under(header, PolicyPackFields{});
  }
  return under(header, smallScene());
}

/// By the number of the asset's type in the schema.
class AssetOfType : public testing::TestWithParam<std::size_t> {};

TEST_P(AssetOfType, IsRefusedUnderTheHeaderOfAnyOtherKind) {
  const PackKind kind = kKinds.at(GetParam() - 1);
  for (const PackKind header : kKinds) {
    SCOPED_TRACE(packKindName(header));
    const AlignedBytes bytes = packUnder(header, kind);
    const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
    ASSERT_EQ(pack.has_value(), header == kind);
    if (pack) continue;
    EXPECT_EQ(pack.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(pack.error().where, "made.pack: asset");
    EXPECT_EQ(pack.error().message, fmt::format("has type {}, the header says {}; bake the pack "
                                                "again",
                                                GetParam(), packKindName(header)));
  }
}

INSTANTIATE_TEST_SUITE_P(OfEachKind, AssetOfType, testing::Range<std::size_t>(1, kKinds.size() + 1),
                         [](const auto& type) { return packKindName(kKinds.at(type.param - 1)); });

}  // namespace
}  // namespace galactic::test::pack_kind_test
