// Texture packs that scenes share: one run looks at each of them once.
#include "asset/texture_packs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "galactic/bake/packs.h"
#include "support/scratch_folder.h"

namespace galactic::test::texture_packs_test {
namespace {

namespace fs = std::filesystem;

/// Writes the pack of a texture of one texel.
Result<void> writeTexel(const fs::path& pack) {
  bake::BakedMaterials materials;
  materials.texels = {1, 2, 3, 255};
  const XXH128_hash_t hash = XXH3_128bits(materials.texels.data(), materials.texels.size());
  materials.textures = {
      {.name = "texel", .size = 1, .hash_low = hash.low64, .hash_high = hash.high64}};
  bake::Provenance provenance;
  provenance.tool_version = "1.2.3";
  const auto written =
      bake::writeTexturePack(pack, materials, materials.textures.front(), provenance);
  EXPECT_TRUE(written) << written.error().text();
  return {};
}

class TexturePacks : public testing::Test {
 protected:
  /// Whether the pack was made for it.
  bool provide() {
    const int before = made_;
    const auto provided = packs_.provide(pack_, [&] {
      ++made_;
      return writeTexel(pack_);
    });
    EXPECT_TRUE(provided) << provided.error().text();
    return made_ > before;
  }
  /// Spoils the pack, which only a reader sees.
  void spoil() const { (void)folder_.write("texel.pack", "no pack"); }

  ScratchFolder folder_;
  fs::path pack_ = folder_.path() / "texel.pack";
  bake::TexturePacks packs_;
  std::atomic<int> made_ = 0;
};

TEST_F(TexturePacks, AreReadOnce) {
  ASSERT_TRUE(writeTexel(pack_));
  EXPECT_FALSE(provide());
  spoil();
  EXPECT_FALSE(provide()) << "was read twice";
  EXPECT_TRUE(packs_.isWhole(pack_)) << "was read twice";
  bake::TexturePacks next_run;
  EXPECT_FALSE(next_run.isWhole(pack_));
}

TEST_F(TexturePacks, AreNotReadWhereTheyWereMade) {
  EXPECT_FALSE(packs_.isWhole(pack_));
  EXPECT_TRUE(provide());
  spoil();
  EXPECT_TRUE(packs_.isWhole(pack_));
  EXPECT_FALSE(provide());
}

TEST_F(TexturePacks, AreMadeAnewWhereTheyAreBroken) {
  spoil();
  EXPECT_TRUE(provide());
  EXPECT_TRUE(bake::TexturePacks().isWhole(pack_));
}

TEST_F(TexturePacks, AreLookedForAgainWhereTheyCouldNotBeMade) {
  const auto failed = packs_.provide(pack_, [] { return fail(ErrorCode::kIo, "disk", "is full"); });
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().text(), "disk: is full");
  EXPECT_FALSE(packs_.isWhole(pack_));
  // By another program.
  ASSERT_TRUE(writeTexel(pack_));
  EXPECT_FALSE(provide());
}

TEST_F(TexturePacks, AreMadeOnceForManyThreads) {
  std::vector<std::thread> threads;
  for (int n = 0; n < 8; ++n) threads.emplace_back([this] { (void)provide(); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(made_, 1);
}

}  // namespace
}  // namespace galactic::test::texture_packs_test
