// Colors, factors, alpha modes, sharing of textures, and what happens to unusable images.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "galactic/bake/triangle_mesh.h"
#include "support/scratch_folder.h"
#include "texture_helpers.h"

namespace galactic::test::materials_test {
namespace {

using bake::AlphaMode;
using bake::BakedMaterials;
using bake::SourceMaterial;
using testing::ElementsAre;
using testing::IsEmpty;

SourceMaterial withAlpha(SourceMaterial material, AlphaMode mode, float cutoff = 0.5F) {
  material.alpha_mode = mode;
  material.alpha_cutoff = cutoff;
  return material;
}

SourceMaterial plain(std::array<float, 4> color) { return textured("", color); }

TEST(PlainMaterials, StoreTheirColorInSrgb) {
  const BakedMaterials baked =
      bakeEmbedded({plain({1, 0.2159F, 0, 0.25F}), plain({0.5F, 0.5F, 0.5F, 1})}, {});
  ASSERT_EQ(baked.materials.size(), 2U);
  EXPECT_EQ(baked.materials[0].name, "paint");
  EXPECT_EQ(baked.materials[0].color, 0xFF0080FFU);
  EXPECT_EQ(baked.materials[0].texture, -1);
  EXPECT_EQ(baked.materials[0].alpha_cutoff, 0.F);
  EXPECT_EQ(baked.materials[1].color, 0xFFBCBCBCU);
  EXPECT_THAT(baked.textures, IsEmpty());
  EXPECT_THAT(baked.texels, IsEmpty());
  EXPECT_THAT(baked.warnings, IsEmpty());
  EXPECT_EQ(baked.source_bytes, 0U);
}

TEST(PlainMaterials, TakeNoNumberForOne) {
  const float nan = std::nanf("");
  const BakedMaterials baked = bakeEmbedded({plain({nan, 2, -1, 1})}, {});
  EXPECT_EQ(baked.materials[0].color, 0xFF00FFFFU);
}

TEST(Factors, MultiplyTexelsInLinearLight) {
  const ImageContent image = busyImage(8, 8);
  const BakedMaterials baked =
      bakeEmbedded({textured("*0", {0.5F, 1, 0.25F, 1})}, {embedded(pngFile(image))});
  const std::array<double, 3> factor{0.5, 1, 0.25};
  for (unsigned y = 0; y < 8; ++y) {
    for (unsigned x = 0; x < 8; ++x) {
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const double linear =
            factor[channel] * srgbToLinear(image.bytes[4 * (std::size_t{y} * 8 + x) + channel]);
        constexpr double kRounding = 0.501;
        ASSERT_NEAR(texelAt(baked, 0, 0, {x, y})[channel], linearToSrgb(linear), kRounding);
      }
    }
  }
}

TEST(SharedTextures, AreStoredOncePerContentAndFactor) {
  const ScratchFolder folder;
  const std::string file = pngFile(busyImage(16, 16));
  static_cast<void>(folder.write("a.png", file));
  static_cast<void>(folder.write("sub/b.png", file));
  // The same texels in another file.
  static_cast<void>(folder.write("c.png", pngFile(busyImage(16, 16), {.interlaced = true})));
  static_cast<void>(folder.write("d.png", pngFile(busyImage(16, 8))));
  const std::array<float, 4> half{0.5F, 0.5F, 0.5F, 1};
  // Alpha of an opaque material does not show.
  const std::array<float, 4> faint{1, 1, 1, 0.5F};
  const std::vector<SourceMaterial> materials{
      textured("a.png"), textured("sub/b.png"),   textured("c.png"), textured("a.png", half),
      textured("d.png"), textured("c.png", half), textured("*0"),    textured("a.png", faint)};
  const std::vector images{embedded(file)};
  const auto baked = bake::bakeMaterials(materials, {images, folder.path()}, {});
  ASSERT_TRUE(baked.has_value());
  std::vector<int> used;
  for (const bake::BakedMaterial& material : baked->materials) used.push_back(material.texture);
  EXPECT_THAT(used, ElementsAre(0, 0, 0, 1, 2, 1, 0, 0));
  ASSERT_EQ(baked->textures.size(), 3U);
  EXPECT_EQ(baked->textures[0].name, "a.png");
  EXPECT_EQ(baked->textures[2].name, "d.png");
  // a.png, c.png and d.png were decoded, the equal files were not.
  EXPECT_EQ(baked->source_bytes, 4U * (256 + 256 + 128));
}

TEST(SharedTextures, NameNoFolderOfThisMachine) {
  const ScratchFolder folder;
  const auto file = folder.write("a.png", pngFile(busyImage(4, 4)));
  const auto baked =
      bake::bakeMaterials(std::vector{textured(file.string())}, {.folder = "elsewhere"}, {});
  ASSERT_TRUE(baked.has_value());
  ASSERT_EQ(baked->textures.size(), 1U);
  EXPECT_EQ(baked->textures[0].name, "a.png");
}

TEST(UniformImages, BecomeFlatColors) {
  const ImageContent image = rgbaImage(32, 16, [](unsigned x, unsigned) {
    return std::array<std::uint8_t, 4>{10, 200, 30, static_cast<std::uint8_t>(x)};
  });
  const BakedMaterials baked = bakeImage(pngFile(image));
  EXPECT_THAT(baked.textures, IsEmpty());
  EXPECT_EQ(baked.materials[0].texture, -1);
  EXPECT_EQ(baked.materials[0].color, 0xFF1EC80AU);
  EXPECT_EQ(baked.source_bytes, 2048U);
}

TEST(UnusableImages, LeaveTheColorAndGiveOneWarningEach) {
  const ScratchFolder folder;
  const std::string good = pngFile(busyImage(8, 8));
  static_cast<void>(folder.write("cut.png", good.substr(0, 60)));
  static_cast<void>(folder.write("basis.ktx2", "\xABKTX 20\xBB\r\n\x1A\n"));
  static_cast<void>(folder.write("webp.png", "RIFF1234WEBP"));
  static_cast<void>(folder.write("empty.png", ""));
  std::filesystem::create_directory(folder.path() / "folder.png");
  std::vector<SourceMaterial> materials;
  for (const char* name : {"cut.png", "basis.ktx2", "webp.png", "empty.png", "folder.png",
                           "absent.png", "absent.png", "*7", "*x", "*0", "*1"}) {
    materials.push_back(textured(name, {0.2159F, 0.2159F, 0.2159F, 1}));
  }
  // The importer has told of an image that is not encoded.
  const std::vector images{embedded(good), embedded("", "raw")};
  const auto baked = bake::bakeMaterials(materials, {images, folder.path()}, {});
  ASSERT_TRUE(baked.has_value());
  EXPECT_THAT(
      baked->warnings,
      ElementsAre(
          "texture 'cut.png' of material 'paint' is a broken PNG (it ends too early): its surfaces "
          "keep their plain color",
          "texture 'basis.ktx2' of material 'paint' is KTX2 (Basis); expected PNG or JPEG: its "
          "surfaces keep their plain color",
          "texture 'webp.png' of material 'paint' is WebP; expected PNG or JPEG: its surfaces keep "
          "their plain color",
          "texture 'empty.png' of material 'paint' is empty: its surfaces keep their plain color",
          "texture 'folder.png' of material 'paint' is not a file: its surfaces keep their plain "
          "color",
          "texture 'absent.png' of material 'paint' is missing: its surfaces keep their plain "
          "color",
          "texture '*7' of material 'paint' is missing: there are 2 embedded images: its surfaces "
          "keep their plain color",
          "texture '*x' of material 'paint' is missing: there are 2 embedded images: its surfaces "
          "keep their plain color"));
  ASSERT_EQ(baked->materials.size(), materials.size());
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const bool usable = materials[m].base_color_texture == "*0";
    EXPECT_EQ(baked->materials[m].texture, usable ? 0 : -1) << m;
    if (!usable) {
      EXPECT_EQ(baked->materials[m].color, 0xFF808080U) << m;
    }
  }
}

/// Fully visible in a share of the texels, absent in the others, in thin irregular strips.
ImageContent leaf(unsigned size, unsigned of_ten) {
  return rgbaImage(size, size, [&](unsigned x, unsigned y) {
    const bool there = (x * 7 + y * 3 + x * y / 16) % 10 < of_ten;
    return there ? std::array<std::uint8_t, 4>{40, 160, 20, 255}
                 : std::array<std::uint8_t, 4>{255, 0, 255, 0};
  });
}

double visibleShare(const BakedMaterials& baked, unsigned level) {
  const unsigned edge = baked.textures[0].size >> level;
  const double cutoff = static_cast<double>(baked.materials[0].alpha_cutoff) * 255;
  double visible = 0;
  for (unsigned y = 0; y < edge; ++y) {
    for (unsigned x = 0; x < edge; ++x) visible += texelAt(baked, 0, level, {x, y})[3] >= cutoff;
  }
  return visible / edge / edge;
}

TEST(CutOuts, KeepTheirVisibleShareInAllLevels) {
  for (const float cutoff : {0.1F, 0.33F, 0.5F, 0.9F, 1.F}) {
    for (const unsigned of_ten : {2U, 5U, 8U}) {
      const ImageContent image = leaf(200, of_ten);
      std::size_t there = 0;
      for (std::size_t i = 3; i < image.bytes.size(); i += 4)
        there += image.bytes[i] != 0 ? 1U : 0U;
      const double wanted = static_cast<double>(there) / (200 * 200);
      const BakedMaterials baked =
          bakeEmbedded({withAlpha(textured("*0"), AlphaMode::kMask, cutoff)},
                       {embedded(pngFile(image))}, {.largest = 128});
      EXPECT_EQ(baked.materials[0].alpha_cutoff, cutoff);
      ASSERT_EQ(baked.textures[0].size, 128U);
      // Ties among few texels let the share jump: from 8 x 8 texels on it is met.
      for (unsigned level = 0; level <= 4; ++level) {
        constexpr double kTies = 0.04;
        EXPECT_NEAR(visibleShare(baked, level), wanted, kTies)
            << "cutoff " << cutoff << ", " << of_ten << " of ten, level " << level;
      }
    }
  }
}

TEST(CutOuts, ShowNoColorOfWhatIsNotThere) {
  const BakedMaterials baked =
      bakeEmbedded({withAlpha(textured("*0"), AlphaMode::kMask)}, {embedded(pngFile(leaf(64, 5)))});
  unsigned edge = 64;
  for (unsigned level = 0; edge > 0; ++level, edge /= 2) {
    for (unsigned y = 0; y < edge; ++y) {
      for (unsigned x = 0; x < edge; ++x) {
        const auto texel = texelAt(baked, 0, level, {x, y});
        ASSERT_THAT((std::array{texel[0], texel[1], texel[2]}), ElementsAre(40, 160, 20));
      }
    }
  }
}

TEST(CutOuts, AreOpaqueWhenNothingIsCutOut) {
  const ImageContent solid = rgbaImage(8, 8, [](unsigned x, unsigned y) {
    return std::array<std::uint8_t, 4>{static_cast<std::uint8_t>(x * 9),
                                       static_cast<std::uint8_t>(y * 9), 0, 200};
  });
  const BakedMaterials baked =
      bakeEmbedded({withAlpha(textured("*0"), AlphaMode::kMask, 0.5F),
                    withAlpha(textured("*0"), AlphaMode::kMask, 0.9F),
                    withAlpha(plain({1, 1, 1, 0.6F}), AlphaMode::kMask, 0.5F),
                    withAlpha(plain({1, 1, 1, 0.4F}), AlphaMode::kMask, 0.5F),
                    withAlpha(plain({1, 1, 1, 0.4F}), AlphaMode::kMask, 0),
                    withAlpha(plain({1, 1, 1, 1}), AlphaMode::kMask, 7)},
                   {embedded(pngFile(solid))});
  std::vector<float> cutoffs;
  for (const bake::BakedMaterial& material : baked.materials) {
    cutoffs.push_back(material.alpha_cutoff);
  }
  EXPECT_THAT(cutoffs, ElementsAre(0.F, 0.9F, 0.F, 0.5F, 0.F, 0.F));
  EXPECT_EQ(texelAt(baked, 0, 0, {1, 1})[3], 255);
  EXPECT_LT(texelAt(baked, 1, 0, {1, 1})[3], 0.9 * 255);
  EXPECT_THAT(baked.warnings, IsEmpty());
}

TEST(Translucency, IsCutAtHalfAndWarnsOnlyWhereItIs) {
  const auto ramp = [](int low, int high) {
    return embedded(pngFile(rgbaImage(16, 16, [&](unsigned x, unsigned y) {
      return std::array<std::uint8_t, 4>{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                                         0, static_cast<std::uint8_t>(y < 4 ? low : high)};
    })));
  };
  const auto blend = [](SourceMaterial material) { return withAlpha(material, AlphaMode::kBlend); };
  const BakedMaterials baked =
      bakeEmbedded({blend(textured("*0")), blend(textured("*1")), blend(textured("*2")),
                    blend(plain({1, 1, 1, 1})), blend(plain({1, 1, 1, 0.3F})),
                    blend(textured("*0", {1, 1, 1, 0.75F}))},
                   {ramp(255, 255), ramp(0, 255), ramp(128, 255)});
  std::vector<float> cutoffs;
  for (const bake::BakedMaterial& material : baked.materials) {
    cutoffs.push_back(material.alpha_cutoff);
  }
  EXPECT_THAT(cutoffs, ElementsAre(0.F, 0.5F, 0.5F, 0.F, 0.5F, 0.5F));
  EXPECT_THAT(baked.warnings,
              ElementsAre("material 'paint' is translucent (25 % of it); it is drawn opaque where "
                          "its alpha is at least 0.5, and not at all elsewhere",
                          "material 'paint' is translucent (100 % of it); it is drawn opaque where "
                          "its alpha is at least 0.5, and not at all elsewhere",
                          "material 'paint' is translucent (100 % of it); it is drawn opaque where "
                          "its alpha is at least 0.5, and not at all elsewhere"));
}

TEST(Baking, GivesTheSameBytesOnAnyNumberOfThreads) {
  std::vector<bake::EmbeddedTexture> images;
  std::vector<SourceMaterial> materials;
  for (unsigned n = 0; n < 12; ++n) {
    const ImageContent image = busyImage(20 + 13 * n, 90 - 5 * n);
    images.push_back(
        embedded(n % 3 == 0 ? jpegFile(withoutAlpha(image), {.quality = 80}) : pngFile(image)));
    materials.push_back(textured(fmt::format("*{}", n)));
    materials.push_back(withAlpha(textured(fmt::format("*{}", 11 - n), {1, 0.5F, 1, 0.8F}),
                                  n % 2 == 0 ? AlphaMode::kBlend : AlphaMode::kMask));
  }
  for (const TexelFormat format : {TexelFormat::kRgba8, TexelFormat::kBc1}) {
    const BakedMaterials once = bakeEmbedded(materials, images, {.format = format});
    ASSERT_GE(once.textures.size(), images.size());
    for (const unsigned threads : {2U, 7U}) {
      const BakedMaterials again = bakeEmbedded(materials, images, {.format = format}, threads);
      EXPECT_EQ(again.texels, once.texels);
      EXPECT_EQ(again.warnings, once.warnings);
      ASSERT_EQ(again.textures.size(), once.textures.size());
      for (std::size_t n = 0; n < once.textures.size(); ++n) {
        EXPECT_EQ(again.textures[n].first_byte, once.textures[n].first_byte);
        EXPECT_EQ(again.textures[n].name, once.textures[n].name);
      }
      for (std::size_t n = 0; n < once.materials.size(); ++n) {
        EXPECT_EQ(again.materials[n].texture, once.materials[n].texture);
        EXPECT_EQ(again.materials[n].color, once.materials[n].color);
      }
    }
  }
}

}  // namespace
}  // namespace galactic::test::materials_test
