// Assets that are baked side by side, with a library of the images that they have in common.
#include <gtest/gtest.h>

#include <span>
#include <string>
#include <thread>
#include <vector>

#include "texture_helpers.h"

namespace galactic::test::texture_library_test {
namespace {

using bake::BakedMaterials;

/// The image that asset `asset` shows in place `place`: each asset begins elsewhere.
std::size_t imageAt(std::size_t asset, std::size_t place, std::size_t count) {
  return (place + asset / 2) % count;
}

/// Bakes assets at the same time, each of which shows all images.
std::vector<BakedMaterials> bakeSideBySide(std::size_t assets, std::span<const std::string> files,
                                           unsigned threads_each, bake::TextureLibrary* library) {
  std::vector<BakedMaterials> baked(assets);
  std::vector<std::thread> threads;
  for (std::size_t asset = 0; asset < assets; ++asset) {
    threads.emplace_back([&, asset] {
      std::vector<bake::EmbeddedTexture> images;
      std::vector<bake::SourceMaterial> materials;
      for (std::size_t place = 0; place < files.size(); ++place) {
        images.push_back(embedded(files[imageAt(asset, place, files.size())]));
        materials.push_back(textured("*" + std::to_string(place)));
      }
      baked[asset] = bakeEmbedded(materials, images, {}, threads_each, library);
    });
  }
  for (std::thread& thread : threads) thread.join();
  return baked;
}

std::vector<std::string> differentImages(unsigned count) {
  std::vector<std::string> files;
  for (unsigned n = 0; n < count; ++n) files.push_back(pngFile(busyImage(24 + 8 * n, 16 + 4 * n)));
  return files;
}

TEST(TextureLibrary, GivesAssetsSideBySideWhatTheyHadAlone) {
  constexpr std::size_t kAssets = 6;
  std::vector<std::string> files = differentImages(5);
  files.emplace_back("no image at all");
  const std::vector<BakedMaterials> alone = bakeSideBySide(kAssets, files, 1, nullptr);
  for (const unsigned threads : {1U, 2U}) {
    bake::TextureLibrary library;
    const std::vector<BakedMaterials> together = bakeSideBySide(kAssets, files, threads, &library);
    for (std::size_t asset = 0; asset < kAssets; ++asset) {
      EXPECT_EQ(together[asset].texels, alone[asset].texels);
      EXPECT_EQ(together[asset].warnings, alone[asset].warnings);
      EXPECT_EQ(together[asset].warnings.size(), 1U);
      EXPECT_EQ(together[asset].textures.size(), 5U);
    }
    // Two of the assets begin with each image.
    EXPECT_EQ(together[0].texels, together[1].texels);
    EXPECT_NE(together[0].texels, together[2].texels);
  }
}

TEST(TextureLibrary, KeepsImagesOfDifferentOptionsApart) {
  bake::TextureLibrary library;
  const std::string file = pngFile(busyImage(64, 64));
  const BakedMaterials large = bakeImage(file, {}, &library);
  const BakedMaterials small = bakeImage(file, {.largest = 16}, &library);
  EXPECT_EQ(large.textures.at(0).size, 64U);
  EXPECT_EQ(small.textures.at(0).size, 16U);
  EXPECT_EQ(small.texels, bakeImage(file, {.largest = 16}).texels);
  EXPECT_EQ(large.texels, bakeImage(file, {}, &library).texels);
}

}  // namespace
}  // namespace galactic::test::texture_library_test
