// Damaged packs: each truncation, each extra byte and each flipped bit.
#include "runtime/check/pack_damage.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "galactic/pack.h"
#include "galactic/scene.h"
#include "support/packs/scene_pack_builder.h"

namespace galactic::test::pack_damage_test {
namespace {

TEST(DamagedPack, IsRefusedAtEachLengthOfATruncation) {
  expectEachTruncationRefused(buildPack(smallScene()));
}

TEST(DamagedPack, IsRefusedWithBytesTooMany) { expectBytesTooManyRefused(buildPack(smallScene())); }

TEST(DamagedPack, IsRefusedAfterEachFlipOfASingleBit) {
  expectEachBitFlipRefused(buildPack(smallScene()));
}

/// Asks the scene about every cell and beyond; a sanitizer sees a read outside the pack.
void queryEverywhere(const PackFile& pack) {
  const Result<Scene> scene = Scene::from(pack);
  ASSERT_TRUE(scene.has_value());
  for (const ColumnGrid& grid : scene->grids()) {
    const ColumnGridLayout& layout = grid.layout();
    std::vector<float> x, y, z;
    const auto add = [&](float at_x, float at_y, float at_z) {
      x.push_back(at_x);
      y.push_back(at_y);
      z.push_back(at_z);
    };
    for (int k = -1; k <= 4; ++k) {
      for (int i = -1; i <= 6; ++i) {
        for (const float part : {0.0F, 0.1F, 0.45F, 0.8F, 1.0F}) {
          add(layout.min_x + (static_cast<float>(i) + 0.5F) * layout.spacing,
              layout.heights.lo + part * (layout.heights.hi - layout.heights.lo),
              layout.min_z + (static_cast<float>(k) + 0.5F) * layout.spacing);
        }
      }
    }
    for (const float extreme :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
          std::numeric_limits<float>::lowest()}) {
      add(extreme, layout.heights.lo, layout.min_z);
      add(layout.min_x, extreme, layout.min_z);
      add(layout.min_x, layout.heights.lo, extreme);
    }
    std::vector<Clearance> clearance(x.size());
    std::vector<float> down(x.size());
    std::vector<float> up(x.size());
    grid.contact({x, y, z}, {clearance, down, up});
    for (std::size_t n = 0; n < x.size(); ++n) {
      const Contact contact = grid.contact({x[n], y[n], z[n]});
      ASSERT_EQ(contact.clearance, clearance[n]);
      ASSERT_EQ(contact.down, down[n]);
      ASSERT_EQ(contact.up, up[n]);
      ASSERT_GE(contact.down, 0);
      ASSERT_GE(contact.up, 0);
    }
  }
}

TEST(DamagedPack, WithARecomputedHashIsRefusedOrSafeToQueryAfterEachFlip) {
  expectFlipsWithARightHashRefusedOrUsable(buildPack(smallScene()), PackKind::kScene,
                                           queryEverywhere);
}

}  // namespace
}  // namespace galactic::test::pack_damage_test
