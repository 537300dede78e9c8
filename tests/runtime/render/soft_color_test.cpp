// Colors and semantic ids of the rasterizer.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "layout/bc1.h"
#include "render/soft/soft_scene.h"
#include "support/packs/render_model_builder.h"
#include "support/render_images.h"

namespace galactic::test::soft_color_test {
namespace {

constexpr std::uint32_t kRed = 0xFF0000FF;
constexpr std::uint32_t kGreen = 0xFF00FF00;
constexpr std::uint32_t kBlue = 0xFFFF0000;

RenderOptions colorOptions(std::uint32_t width, std::uint32_t height) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.semantics = true;
  options.backend = RenderBackend::kSoft;
  options.threads = 1;
  options.background = 0x40302010;
  return options;
}

std::uint32_t pixel(const RenderImages& images, std::size_t number) {
  const std::uint8_t* p = images.color.data() + 4 * number;
  return std::uint32_t{p[0]} | std::uint32_t{p[1]} << 8U | std::uint32_t{p[2]} << 16U |
         std::uint32_t{p[3]} << 24U;
}

/// A square of this edge in the plane x = `x`, facing the camera at the origin, upright.
std::array<Vec3, 4> facing(float x, float edge) {
  const float half = edge / 2;
  return {Vec3{x, -half, -half}, {x, -half, half}, {x, half, half}, {x, half, -half}};
}

/// One view of a builder's model 0, where it stands.
RenderImages draw(const RenderModelBuilder& builder, const RenderOptions& options,
                  const RenderCamera& camera = {}) {
  RenderLibrary library;
  library.add(builder.meshes());
  const std::vector<RenderInstance> instances = {{0, {}}};
  const RenderView view{camera, instances};
  return renderViews(library, options, {&view, 1});
}

std::vector<std::uint32_t> randomTexels(std::mt19937& random, std::uint32_t size) {
  std::vector<std::uint32_t> texels(std::size_t{size} * size);
  for (std::uint32_t& texel : texels) texel = static_cast<std::uint32_t>(random()) | 0xFF000000U;
  return texels;
}

TEST(SoftColor, ATexelPerPixelGivesTheTexelsThemselves) {
  std::mt19937 random(31);
  const std::vector<std::uint32_t> texels = randomTexels(random, 64);
  RenderModelBuilder builder;
  const std::uint16_t surface = builder.material(0, builder.texture(64, texels));
  builder.model();
  // 64 pixels of the image's 128 at a distance of 2 m and 90 degrees.
  builder.quad(facing(2, 2), {.material = surface});
  builder.finish();
  const RenderImages images = draw(builder, colorOptions(128, 128));
  for (std::uint32_t y = 0; y < 128; ++y) {
    for (std::uint32_t x = 0; x < 128; ++x) {
      const bool inside = x >= 32 && x < 96 && y >= 32 && y < 96;
      const std::uint32_t expected = inside ? texels[(y - 32) * 64 + x - 32] : 0x40302010U;
      ASSERT_EQ(pixel(images, y * 128 + x), expected) << x << ", " << y;
      ASSERT_EQ(images.semantics[y * 128 + x], inside ? 1U : 0U);
    }
  }
}

TEST(SoftColor, OfACheckerboardIsExactAwayFromEdgesAtEveryDistance) {
  std::vector<std::uint32_t> texels(256 * 256);
  for (std::uint32_t n = 0; n < texels.size(); ++n) {
    texels[n] = ((n / 256 / 64 + n % 256 / 64) % 2 == 0) ? kRed : kBlue;
  }
  RenderModelBuilder builder;
  const std::uint16_t surface = builder.material(0, builder.texture(256, texels));
  builder.model();
  builder.quad(facing(0, 2), {.material = surface});
  builder.finish();
  RenderLibrary library;
  library.add(builder.meshes());
  std::size_t red = 0;
  std::size_t blue = 0;
  for (const float distance : {0.5F, 1.0F, 1.7F, 3.0F}) {
    const std::vector<RenderInstance> instances = {{0, {.origin = {distance, 0, 0}}}};
    const RenderView view{{}, instances};
    const RenderImages images = renderViews(library, colorOptions(128, 128), {&view, 1});
    for (std::uint32_t y = 0; y < 128; ++y) {
      for (std::uint32_t x = 0; x < 128; ++x) {
        // In fields of the board, from its upper left corner.
        const auto field = [&](std::uint32_t at) {
          return 2 + (static_cast<double>(at) - 63.5) / 64 * static_cast<double>(distance) * 2;
        };
        const double u = field(x);
        const double v = field(y);
        // Two pixels from the edges of fields: a mip level blends that far.
        const double margin = static_cast<double>(distance) / 16;
        const auto clear = [&](double at) {
          return std::abs(at - std::round(at)) > margin && at > 0 && at < 4;
        };
        if (!clear(u) || !clear(v)) continue;
        const bool is_red = (static_cast<int>(u) + static_cast<int>(v)) % 2 == 0;
        (is_red ? red : blue) += 1;
        ASSERT_EQ(pixel(images, y * 128 + x), is_red ? kRed : kBlue) << x << ", " << y;
      }
    }
  }
  EXPECT_GT(red, 5000U);
  EXPECT_GT(blue, 5000U);
}

TEST(SoftColor, TakesTheLevelWhoseTexelsAreNearestToPixels) {
  // Each level of this texture has one color of its own.
  RenderModelBuilder builder;
  const std::int32_t texture = builder.texture(64, std::vector<std::uint32_t>(64 * 64, kRed));
  const std::uint16_t surface = builder.material(0, texture);
  builder.model();
  builder.quad(facing(0, 2), {.material = surface});
  builder.finish();
  RenderMeshes meshes = builder.meshes();
  std::vector<std::uint32_t> texels;
  for (std::uint32_t level = 0; level < 7; ++level) {
    const std::uint32_t edge = 64U >> level;
    texels.insert(texels.end(), std::size_t{edge} * edge, 0xFF000000U | (level + 1));
  }
  meshes.textures[0].texels = {reinterpret_cast<const std::uint8_t*>(texels.data()),
                               texels.size() * 4};
  RenderLibrary library;
  library.add(meshes);
  std::array<std::size_t, 8> seen{};
  for (float distance = 0.4F; distance < 150; distance *= 1.07F) {
    const std::vector<RenderInstance> instances = {{0, {.origin = {distance, 0, 0}}}};
    RenderView view{{}, instances};
    const RenderImages images = renderViews(library, colorOptions(127, 127), {&view, 1});
    // 32 texels per meter, 63.5 / distance pixels.
    const double level = std::log2(32 * static_cast<double>(distance) / 63.5);
    const double rounded = std::clamp(std::round(level), 0.0, 6.0);
    if (std::abs(level - std::floor(level) - 0.5) < 0.01) continue;
    const std::uint32_t middle = pixel(images, 63 * 127 + 63) & 0xFFU;
    EXPECT_EQ(middle, rounded + 1) << distance;
    ++seen[middle];
  }
  for (std::size_t level = 1; level < 7; ++level) EXPECT_GT(seen[level], 3U) << level;
}

TEST(SoftColor, RepeatsTexturesBeyondTheirEdges) {
  std::mt19937 random(32);
  const std::vector<std::uint32_t> texels = randomTexels(random, 16);
  RenderModelBuilder builder;
  const std::uint16_t surface = builder.material(0, builder.texture(16, texels));
  builder.model();
  // 128 x 128 pixels, 8 x 8 times the texture from a multiple of it on.
  const std::array<Vec3, 4> c = facing(1, 2);
  builder.triangle({RenderVertex{c[0], -3, 5}, {c[1], 5, 5}, {c[2], 5, -3}}, {.material = surface});
  builder.triangle({RenderVertex{c[0], -3, 5}, {c[2], 5, -3}, {c[3], -3, -3}},
                   {.material = surface});
  builder.finish();
  const RenderImages images = draw(builder, colorOptions(128, 128));
  for (std::uint32_t y = 0; y < 128; ++y) {
    for (std::uint32_t x = 0; x < 128; ++x) {
      const std::uint32_t texel = texels[y % 16 * 16 + x % 16];
      const std::uint32_t drawn = pixel(images, y * 128 + x);
      for (std::uint32_t shift = 0; shift < 32; shift += 8) {
        // Texture coordinates are stored in 16 bits: a blend of neighbors of up to 1/256.
        ASSERT_NEAR((drawn >> shift) & 0xFFU, (texel >> shift) & 0xFFU, 2) << x << ", " << y;
      }
    }
  }
}

TEST(SoftColor, CornersColorsMultiplyAndFollowPerspective) {
  RenderModelBuilder builder(1.0F / 1024);
  const std::uint16_t surface = builder.material(0xFF80FF40);
  builder.keepColors();
  builder.model();
  // A floor from 1 m to 9 m ahead, black at the near end, white at the far one.
  const std::array<RenderVertex, 4> c = {RenderVertex{{1, -1, -9}, 0, 0, 0xFF000000},
                                         {{1, -1, 9}, 0, 0, 0xFF000000},
                                         {{9, -1, 9}, 0, 0, 0xFFFFFFFF},
                                         {{9, -1, -9}, 0, 0, 0xFFFFFFFF}};
  const RenderSurface two_sided{.material = surface, .two_sided = true};
  builder.triangle({c[0], c[1], c[2]}, two_sided);
  builder.triangle({c[0], c[2], c[3]}, two_sided);
  builder.finish();
  const RenderImages images = draw(builder, colorOptions(128, 128));
  std::size_t checked = 0;
  for (std::uint32_t y = 73; y < 127; ++y) {
    // The floor is 1 m below the eye.
    const double distance = 64 / (y + 0.5 - 64);
    if (distance < 1.02 || distance > 8.9) continue;
    const double share = (distance - 1) / 8;
    for (std::uint32_t x = 50; x < 80; ++x) {
      const std::uint32_t drawn = pixel(images, y * 128 + x);
      EXPECT_NEAR(drawn & 0xFFU, 0x40 * share, 1.1) << x << ", " << y;
      EXPECT_NEAR((drawn >> 8U) & 0xFFU, 0xFF * share, 1.1);
      EXPECT_NEAR((drawn >> 16U) & 0xFFU, 0x80 * share, 1.1);
      ++checked;
    }
  }
  EXPECT_GT(checked, 1000U);
}

/// Random triangles in front of the camera, near, far and across its near plane: textured, plain
/// and with holes, in shades of gray. `colored`: a red corner that nobody sees in each cluster.
RenderModelBuilder grayTriangles(bool colored) {
  std::mt19937 random(11);
  RenderModelBuilder builder(1.0F / 4096);
  std::vector<std::uint32_t> texels = randomTexels(random, 16);
  const std::int32_t opaque = builder.texture(16, texels);
  for (std::uint32_t& texel : texels) {
    if (random() % 3 == 0) texel &= 0xFFFFFFU;
  }
  const std::int32_t leaf = builder.texture(16, texels);
  const std::array materials{builder.material(0xFFFFFFFF, opaque), builder.material(0xFF40C080),
                             builder.material(0xFFFFFFFF, leaf, 0.5F)};
  builder.keepColors();
  builder.model();
  const auto corner = [&](const Vec3& middle, float reach) {
    const auto off = [&] { return uniform(random, -reach, reach); };
    const auto gray = static_cast<std::uint32_t>(random() % 256);
    return RenderVertex{{middle.x + off(), middle.y + off(), middle.z + off()},
                        uniform(random, 0, 3),
                        uniform(random, 0, 3),
                        0xFF000000U | gray * 0x010101U};
  };
  for (int cluster = 0; cluster < 24; ++cluster) {
    const RenderSurface surface{.material = materials[static_cast<std::size_t>(cluster) % 3],
                                .semantic = builder.semantic("thing"),
                                .two_sided = true};
    const Vec3 middle{uniform(random, 0.3F, 4), uniform(random, -1, 1), uniform(random, -1, 1)};
    for (int n = 0; n < 10; ++n) {
      const float reach = n == 0 ? 2.0F : 0.4F;
      builder.triangle({corner(middle, reach), corner(middle, reach), corner(middle, reach)},
                       surface);
    }
    const std::uint32_t behind = colored ? kRed : 0xFF808080U;
    builder.triangle({RenderVertex{{-3, 0, 0}, 0, 0, behind},
                      {{-3, 0, 1}, 0, 0, behind},
                      {{-3, 1, 0}, 0, 0, behind}},
                     surface);
  }
  builder.finish();
  return builder;
}

TEST(SoftColor, GrayCornersGiveTheBitsThatColoredOnesGive) {
  // Light that is baked in is gray and goes a shorter way.
  const RenderImages gray = draw(grayTriangles(false), colorOptions(200, 150));
  const RenderImages colored = draw(grayTriangles(true), colorOptions(200, 150));
  EXPECT_EQ(gray.color, colored.color);
  EXPECT_EQ(gray.depth, colored.depth);
  EXPECT_EQ(gray.semantics, colored.semantics);
  std::set<std::uint32_t> seen;
  for (std::size_t n = 0; n < std::size_t{200} * 150; ++n) seen.insert(pixel(gray, n));
  EXPECT_GT(seen.size(), 5000U);
}

TEST(SoftColor, WhiteCornersChangeNothing) {
  const auto square = [](bool keep) {
    RenderModelBuilder builder;
    std::mt19937 random(5);
    const std::uint16_t wood =
        builder.material(0xFFFFFFFF, builder.texture(8, randomTexels(random, 8)));
    if (keep) builder.keepColors();
    builder.model();
    builder.quad(facing(1.5F, 1.3F), {.material = wood});
    builder.finish();
    return builder;
  };
  EXPECT_EQ(draw(square(true), colorOptions(90, 90)).color,
            draw(square(false), colorOptions(90, 90)).color);
}

TEST(SoftColor, TwoSidedLeavesShowFromBehindAndOthersDoNot) {
  for (const bool two_sided : {false, true}) {
    RenderModelBuilder builder;
    const std::uint16_t surface = builder.material(kGreen);
    builder.model();
    builder.quad(facing(2, 1), {.material = surface, .two_sided = two_sided});
    builder.finish();
    const RenderOptions options = colorOptions(64, 64);
    const std::size_t middle = 32 * 64 + 32;
    EXPECT_EQ(pixel(draw(builder, options), middle), kGreen);
    // From the other side.
    RenderCamera behind;
    behind.world_from_camera = {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {4, 0, 0}};
    EXPECT_EQ(pixel(draw(builder, options, behind), middle), two_sided ? kGreen : 0x40302010U);
  }
}

TEST(SoftColor, AlphaMasksCutHolesThroughWhichOneSees) {
  // Stripes of 8 texels that are there and not.
  std::vector<std::uint32_t> texels(64 * 64);
  for (std::uint32_t n = 0; n < texels.size(); ++n) {
    texels[n] = n % 64 / 8 % 2 == 0 ? kRed : 0x000000FFU;
  }
  RenderModelBuilder builder;
  const std::uint16_t leaf = builder.material(0, builder.texture(64, texels), 0.5F);
  const std::uint16_t wall = builder.material(kGreen);
  const std::uint16_t second = builder.semantic("leaf");
  builder.model();
  // The first quad is one large triangle pair; of the second 32 x 32 small ones.
  const auto point = [](int n, int m) {
    const auto at = [](int k) { return static_cast<float>(k) / 16 - 1; };
    return RenderVertex{
        {2, at(m), at(n)}, static_cast<float>(n) / 32, 1 - static_cast<float>(m) / 32};
  };
  for (const int parts : {1, 32}) {
    builder.model();
    builder.quad(facing(3, 8), {.material = wall});
    const int step = 32 / parts;
    const RenderSurface surface{.material = leaf, .semantic = second};
    for (int n = 0; n < 32; n += step) {
      for (int m = 0; m < 32; m += step) {
        const RenderVertex a = point(n, m);
        const RenderVertex b = point(n + step, m);
        const RenderVertex c = point(n + step, m + step);
        const RenderVertex d = point(n, m + step);
        builder.triangle({a, b, c}, surface);
        builder.triangle({a, c, d}, surface);
      }
    }
  }
  builder.finish();
  RenderLibrary library;
  library.add(builder.meshes());
  for (const std::uint32_t model : {1U, 2U}) {
    const std::vector<RenderInstance> instances = {{model, {}}};
    const RenderView view{{}, instances};
    const RenderImages images = renderViews(library, colorOptions(128, 128), {&view, 1});
    for (std::uint32_t y = 32; y < 96; ++y) {
      for (std::uint32_t x = 32; x < 96; ++x) {
        const std::size_t at = y * 128 + x;
        const bool there = (x - 32) / 8 % 2 == 0;
        ASSERT_EQ(pixel(images, at), there ? kRed : kGreen) << x << ", " << y;
        ASSERT_EQ(images.semantics[at], there ? 2U : 1U);
        ASSERT_NEAR(images.depth[at], there ? 2 : 3, 1e-3F);
      }
    }
  }
}

TEST(SoftColor, SemanticsOfSeveralPacksFollowEachOther) {
  RenderModelBuilder first;
  first.semantic("second of the first");
  first.model();
  first.quad(facing(2, 1));
  first.finish();
  RenderModelBuilder second;
  const std::uint16_t id = second.semantic("second of the second");
  second.model();
  second.quad(facing(1, 0.5F), {.semantic = id});
  second.finish();
  RenderLibrary library;
  library.add(first.meshes(), "a/");
  library.add(second.meshes(), "b/");
  const std::vector<RenderInstance> instances = {{0, {.origin = {0, 0, -1}}},
                                                 {1, {.origin = {0, 0, 0.5F}}}};
  const RenderView view{{}, instances};
  const RenderImages images = renderViews(library, colorOptions(128, 128), {&view, 1});
  const auto name_at = [&](std::size_t x) {
    return library.semanticNames()[images.semantics[64 * 128 + x]];
  };
  EXPECT_EQ(name_at(32), "a/thing");
  EXPECT_EQ(name_at(96), "b/second of the second");
  EXPECT_EQ(name_at(127), "background");
}

TEST(SoftColor, ThreeBytesPerPixelAreTheFirstThreeOfFour) {
  std::mt19937 random(33);
  RenderModelBuilder builder;
  builder.model();
  const std::uint16_t surface = builder.material(0, builder.texture(32, randomTexels(random, 32)));
  builder.quad(facing(2, 3), {.material = surface});
  builder.finish();
  RenderOptions options = colorOptions(77, 43);
  const RenderImages four = draw(builder, options);
  options.color = ColorFormat::kRgb8;
  const RenderImages three = draw(builder, options);
  for (std::size_t n = 0; n < std::size_t{77} * 43; ++n) {
    for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(three.color[3 * n + c], four.color[4 * n + c]);
  }
  EXPECT_EQ(three.depth, four.depth);
  EXPECT_EQ(three.semantics, four.semantics);
}

TEST(SoftColor, EachImageIsTheSameWhateverOthersAreAskedFor) {
  RenderModelBuilder builder;
  builder.model();
  builder.quad(facing(2, 3), {.material = builder.material(kBlue)});
  builder.finish();
  RenderOptions options = colorOptions(40, 30);
  const RenderImages all = draw(builder, options);
  options.color = ColorFormat::kNone;
  EXPECT_EQ(draw(builder, options).depth, all.depth);
  EXPECT_EQ(draw(builder, options).semantics, all.semantics);
  options.depth = false;
  EXPECT_EQ(draw(builder, options).semantics, all.semantics);
  options.semantics = false;
  options.color = ColorFormat::kRgba8;
  EXPECT_EQ(draw(builder, options).color, all.color);
}

TEST(SoftColor, Bc1BlocksDecodeToTheColorsOfTheirFormat) {
  // Red and blue, the two between, by the rows' choices 0, 1, 2, 3.
  const std::vector<std::uint8_t> four = {0x00, 0xF8, 0x1F, 0x00, 0xE4, 0xE4, 0xE4, 0xE4};
  std::vector<std::uint8_t> blocks = four;
  blocks.insert(blocks.end(), four.begin(), four.end());  // level of 2 x 2
  // Of one texel, in the other mode: green 0 < white, half way between is choice 2.
  const std::vector<std::uint8_t> half = {0x00, 0x00, 0xFF, 0xFF, 0x02, 0x00, 0x00, 0x00};
  blocks.insert(blocks.end(), half.begin(), half.end());
  std::vector<std::uint32_t> texels;
  render::decodeBc1(blocks, 4, texels);
  ASSERT_EQ(texels.size(), 16U + 4U + 1U);
  EXPECT_EQ(texels[0], kRed);
  EXPECT_EQ(texels[1], kBlue);
  EXPECT_EQ(texels[2], 0xFF5500AA);
  EXPECT_EQ(texels[3], 0xFFAA0055);
  EXPECT_EQ(texels[16], kRed);
  EXPECT_EQ(texels[20], 0xFF808080);
}

/// Of 4 x 4 texels and two smaller levels.
using SmallBlocks = std::array<std::uint8_t, 24>;

/// A model that has a material for each of some textures of such blocks.
RenderModelBuilder texturedModel(std::size_t textures) {
  RenderModelBuilder builder;
  for (std::size_t n = 0; n < textures; ++n) {
    builder.material(0, builder.texture(4, std::vector<std::uint32_t>(16)));
  }
  builder.model();
  builder.quad(facing(2, 2), {});
  builder.finish();
  return builder;
}

TEST(SoftColor, ATextureOfBlocksIsUnpackedOnceToWhereItsNumbersReach) {
  std::mt19937 random(32);
  std::array<SmallBlocks, 3> blocks;
  for (SmallBlocks& of_texture : blocks) {
    for (std::uint8_t& byte : of_texture) byte = static_cast<std::uint8_t>(random());
  }
  // Two packs share the first texture; material 0 of a builder has none.
  const std::array<std::array<std::size_t, 2>, 2> wanted{{{0, 1}, {0, 2}}};
  const RenderModelBuilder builder = texturedModel(2);
  RenderLibrary library;
  for (const auto& of_pack : wanted) {
    RenderMeshes meshes = builder.meshes();
    for (std::size_t n = 0; n < of_pack.size(); ++n) {
      meshes.textures[n].format = TexelFormat::kBc1;
      meshes.textures[n].texels = blocks[of_pack[n]];
    }
    library.add(std::move(meshes));
  }
  constexpr std::size_t kTexels = 16 + 4 + 1;
  // Room for two of the three.
  const render::SoftScene scene(library, 2 * kTexels * sizeof(std::uint32_t));
  std::array<std::set<const std::uint32_t*>, 3> places;
  std::set<std::uint32_t> bases;
  for (std::size_t pack = 0; pack < wanted.size(); ++pack) {
    for (std::size_t n = 0; n < 2; ++n) {
      const render::SurfaceTexels& surface = scene.models()[pack].pack->surfaces[n + 1];
      const std::uint32_t base = surface.kind >> 8U;
      const std::uint32_t* first = scene.texelBases()[base] + surface.texels;
      std::vector<std::uint32_t> texels;
      render::decodeBc1(blocks[wanted[pack][n]], 4, texels);
      EXPECT_TRUE(std::equal(texels.begin(), texels.end(), first)) << pack << ", " << n;
      places[wanted[pack][n]].insert(first);
      bases.insert(base);
    }
  }
  for (const auto& places_of_one : places) EXPECT_EQ(places_of_one.size(), 1U);
  EXPECT_EQ(bases.size(), 2U);
}

}  // namespace
}  // namespace galactic::test::soft_color_test
