// The software rasterizer and the pictures of figures.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "pack_tool/asset_packs.h"
#include "pack_tool/figure/figures_of_pack.h"
#include "pack_tool/painted_meshes.h"
#include "pack_tool/pictures/figure_picture.h"
#include "pack_tool/pictures/figure_view.h"
#include "pack_tool/pictures/mesh_raster.h"
#include "pictures/drawing.h"
#include "pictures/palette.h"
#include "support/build_paths.h"

namespace galactic::pictures::raster_test {
namespace {

using pack_tool::Figure;
using pack_tool::figuresOf;
using test::ToyObjects;
using test::ToyPack;
using test::ToyRobot;
using testing::HasSubstr;

constexpr unsigned kSeed = 20230611;
constexpr int kSize = 64;
/// One pixel per centimeter, the origin in the middle.
const RasterView kSide{kSideView, {0, 0, 0}, 100, kSize, kSize};
constexpr Rgb kRed{200, 0, 0};
constexpr Rgb kBlue{0, 0, 200};

Image imageOf(const MeshRaster& raster) {
  Image image(kSize, kSize, kInk);
  raster.compose(image, 0, 0);
  return image;
}

/// The world point that the middle of a pixel shows in kSide, at z = 0.
Vec3 pointOf(int x, int y) {
  return {(static_cast<float>(x) + 0.5F - kSize / 2) / 100,
          (kSize / 2 - static_cast<float>(y) - 0.5F) / 100, 0};
}

void drawTriangle(MeshRaster& raster, const std::array<Vec3, 3>& corners, Rgb color) {
  constexpr std::array<std::uint32_t, 3> kCorners{0, 1, 2};
  raster.drawMesh({corners, kCorners, {}, color}, {});
}

/// Least distance of a point from the lines through the edges of a triangle in the plane z = 0,
/// negative outside.
double depthInside(const std::array<Vec3, 3>& c, const Vec3& p) {
  const auto side = [](const Vec3& a, const Vec3& b, const Vec3& q) {
    const double x = static_cast<double>(b.x - a.x);
    const double y = static_cast<double>(b.y - a.y);
    return (x * static_cast<double>(q.y - a.y) - y * static_cast<double>(q.x - a.x)) /
           std::hypot(x, y);
  };
  const double turn = side(c[0], c[1], c[2]) > 0 ? 1 : -1;
  return std::min(
      {turn * side(c[0], c[1], p), turn * side(c[1], c[2], p), turn * side(c[2], c[0], p)});
}

TEST(MeshRaster, ColorsExactlyThePixelsInsideATriangle) {
  std::mt19937 random(kSeed);
  const auto coordinate = [&random] {
    return (static_cast<float>(random() % 1000) - 500) * 0.0012F;
  };
  int inside = 0;
  int outside = 0;
  for (int n = 0; n < 40; ++n) {
    const std::array<Vec3, 3> corners{Vec3{coordinate(), coordinate(), 0},
                                      Vec3{coordinate(), coordinate(), 0},
                                      Vec3{coordinate(), coordinate(), 0}};
    MeshRaster raster(kSide);
    drawTriangle(raster, corners, kRed);
    const Image image = imageOf(raster);
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        // Pixels that an edge crosses are mixed: half a diagonal is 0.71 pixels.
        const double depth = depthInside(corners, pointOf(x, y));
        if (std::abs(depth) < 0.0072) continue;
        const bool drawn = image.at(x, y) != kPaper;
        ASSERT_EQ(drawn, depth > 0)
            << "seed " << kSeed << " case " << n << " at " << x << ", " << y;
        ++(drawn ? inside : outside);
      }
    }
  }
  EXPECT_GT(inside, (inside + outside) / 10);
  EXPECT_GT(outside, (inside + outside) / 10);
}

TEST(MeshRaster, ShowsWhatIsNearerWhateverComesFirst) {
  const auto large = [](float z) {
    return std::array<Vec3, 3>{Vec3{-1, -1, z}, Vec3{1, -1, z}, Vec3{0, 1, z}};
  };
  for (const bool red_first : {true, false}) {
    MeshRaster raster(kSide);
    if (red_first) drawTriangle(raster, large(0.1F), kRed);
    drawTriangle(raster, large(0), kBlue);
    if (!red_first) drawTriangle(raster, large(0.1F), kRed);
    const Rgb middle = imageOf(raster).at(kSize / 2, kSize / 2);
    EXPECT_GT(middle.r, 0);
    EXPECT_EQ(middle.b, 0);
  }
}

TEST(MeshRaster, GivesSpheresTheirAreaAndLetsShineThroughWhatIsBehind) {
  MeshRaster raster(kSide);
  constexpr float kRadius = 0.2F;
  raster.drawSphere({{0.05F, 0, 0}, kRadius}, kBlue);
  const Image image = imageOf(raster);
  int covered = 0;
  for (const Rgb& pixel : image.pixels()) covered += pixel != kPaper ? 1 : 0;
  // Pixels on the rim count as covered: up to half a pixel around.
  const double least = std::numbers::pi * 20 * 20;
  EXPECT_GT(covered, 0.98 * least);
  EXPECT_LT(covered, std::numbers::pi * 21 * 21);
  const Rgb middle = image.at(kSize / 2 + 5, kSize / 2);
  EXPECT_GT(middle.r, 60);
  EXPECT_GT(middle.b, middle.r);

  // Inside a mesh, nothing of it is seen.
  MeshRaster hidden(kSide);
  drawTriangle(hidden, {Vec3{-2, -1, 0.5F}, Vec3{2, -1, 0.5F}, Vec3{0, 2, 0.5F}}, kRed);
  hidden.drawSphere({{0, 0, 0}, kRadius}, kBlue);
  EXPECT_EQ(imageOf(hidden).at(kSize / 2, kSize / 2).b, 0);
}

TEST(MeshRaster, LetsHiddenLinesShineFaintlyThroughMeshes) {
  const std::array<Vec3, 3> wall{Vec3{-2, -1, 0}, Vec3{2, -1, 0}, Vec3{0, 2, 0}};
  const auto lineAt = [&wall](float z) {
    MeshRaster raster(kSide);
    drawTriangle(raster, wall, kRed);
    raster.drawLine({{-0.3F, 0, z}, {0.3F, 0, z}, kBlue});
    return imageOf(raster).at(kSize / 2, kSize / 2);
  };
  EXPECT_EQ(lineAt(0.1F), kBlue);
  EXPECT_GT(lineAt(-0.1F).b, 0);
  EXPECT_LT(lineAt(-0.1F).b, kBlue.b / 2);
}

TEST(MeshRaster, DrawsNothingOutsideItsPlace) {
  MeshRaster raster(kSide);
  drawTriangle(raster, {Vec3{-9, -9, 0}, Vec3{9, -9, 0}, Vec3{0, 90, 0}}, kRed);
  raster.drawSphere({{50, 50, 0}, 1}, kBlue);
  raster.drawLine({{-50, 0, 0}, {50, 0, 0}, kBlue});
  Image image(kSize + 2, kSize + 2, kInk);
  raster.compose(image, 1, 1);
  for (int n = 0; n < kSize + 2; ++n) {
    EXPECT_EQ(image.at(n, 0), kInk);
    EXPECT_EQ(image.at(n, kSize + 1), kInk);
    EXPECT_EQ(image.at(0, n), kInk);
    EXPECT_EQ(image.at(kSize + 1, n), kInk);
  }
}

TEST(MeshRaster, DrawsRenderModelsWithTheirTexturesAndSides) {
  const RenderMeshStorage storage = test::paintedStorage();
  const RenderMeshes meshes = storage.view();
  // From the front, the leaf with its holes before the wall; from behind, the leaf alone.
  const auto colorsFrom = [&](const ViewAxes& axes, const Vec3& center) {
    MeshRaster raster({axes, center, 60, kSize, kSize});
    raster.drawRenderModel(meshes, meshes.models.front(), {});
    const Image image = imageOf(raster);
    std::vector<Rgb> colors;
    for (const Rgb& pixel : image.pixels()) {
      if (pixel != kPaper) colors.push_back(pixel);
    }
    return colors.size();
  };
  const std::size_t front = colorsFrom(kSideView, {0.5F, 0.5F, 0});
  const ViewAxes behind{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  const std::size_t back = colorsFrom(behind, {0.5F, 0.5F, 0});
  // The leaf is 60 by 60 pixels, the wall covers what its holes show.
  EXPECT_GT(front, 60U * 60);
  EXPECT_GT(back, 60U * 60 / 2);
  EXPECT_LT(back, 60U * 60 * 95 / 100);
}

/// Clusters begin at their least coordinates, so that a pack has twice what its source may have.
TEST(MeshRaster, DrawsTexturesThatRepeatAsOftenAsPacksCanHold) {
  const std::vector<std::uint8_t> green{0, 200, 0, 255};
  RenderMeshSource source;
  source.textures = {{"green.png", 1, TexelFormat::kRgba8, green}};
  source.materials = {{"green", 0xFFFFFFFF, 0}};
  source.semantics = {"wall"};
  RenderSurface surface;
  for (const Vec3& corner : {Vec3{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}) {
    surface.vertices.push_back(
        {.position = corner, .u = kMostImages * corner.x, .v = kMostImages * corner.y});
  }
  surface.corners = {0, 1, 2, 0, 2, 3};
  surface.two_sided = true;
  source.parts = {{.part = 0, .surfaces = {surface}}};
  const auto storage = buildRenderMeshes(source);
  ASSERT_TRUE(storage) << storage.error().text();
  const RenderMeshes meshes = storage->view();
  MeshRaster raster({kSideView, {0, 0, 0}, 20, kSize, kSize});
  raster.drawRenderModel(meshes, meshes.models.front(), {});
  const Rgb drawn = imageOf(raster).at(kSize / 2, kSize / 2);
  EXPECT_EQ(drawn.r, 0);
  EXPECT_GT(drawn.g, 100);
}

/// A square of a plain color that leans away from the light, and what its vertices have.
Rgb leaningSquare(std::uint32_t color) {
  RenderMeshSource source;
  source.materials = {{"plain", 0xFFFFFFFF}};
  source.semantics = {"wall"};
  RenderSurface surface;
  for (const Vec3& corner : {Vec3{-1, -1, 0.5F}, {1, -1, 0.5F}, {1, 1, -0.5F}, {-1, 1, -0.5F}}) {
    surface.vertices.push_back({.position = corner, .color = color});
  }
  surface.corners = {0, 2, 1, 0, 3, 2};
  surface.two_sided = true;
  source.parts = {{.part = 0, .surfaces = {surface}}};
  const auto storage = buildRenderMeshes(source);
  EXPECT_TRUE(storage);
  const RenderMeshes meshes = storage->view();
  MeshRaster raster({kFrontView, {0, 0, 0}, 20, kSize, kSize});
  // Seen from its side's front, turned away from the lamp.
  raster.drawRenderModel(meshes, meshes.models.front(), {{0, 0, 0}, {0, 0.8F, 0, 0.6F}});
  return imageOf(raster).at(kSize / 2, kSize / 2);
}

TEST(MeshRaster, ShadesOnlyWhatHasNoLightInItsVertices) {
  const Rgb without = leaningSquare(0xFFFFFFFF);
  EXPECT_LT(without.g, 240);
  const Rgb with = leaningSquare(0xFF80C0E0);
  EXPECT_EQ(with, (Rgb{0xE0, 0xC0, 0x80}));
}

TEST(ViewAxes, AreRightHanded) {
  for (const ViewAxes& axes : {kFrontView, kSideView, kTopView, threeQuarterView()}) {
    const Vec3 toward = cross(axes.right, axes.up);
    constexpr float kRounding = 1e-6F;
    EXPECT_NEAR(toward.x, axes.toward.x, kRounding);
    EXPECT_NEAR(toward.y, axes.toward.y, kRounding);
    EXPECT_NEAR(toward.z, axes.toward.z, kRounding);
    EXPECT_NEAR(dot(axes.right, axes.right), 1, kRounding);
    EXPECT_NEAR(dot(axes.up, axes.up), 1, kRounding);
  }
}

/// How many pixels have about the hue of a color: the same share of light in each channel.
int pixelsLike(const Image& image, Rgb color) {
  const auto shares = [](Rgb c) {
    const double sum = std::max(1, c.r + c.g + c.b);
    return std::array{c.r / sum, c.g / sum, c.b / sum};
  };
  constexpr double kNear = 0.05;
  const auto wanted = shares(color);
  return static_cast<int>(std::ranges::count_if(image.pixels(), [&](const Rgb& pixel) {
    const auto found = shares(pixel);
    bool is_near = pixel.r + pixel.g + pixel.b > 60;
    for (std::size_t n = 0; n < found.size(); ++n) {
      is_near = is_near && std::abs(found[n] - wanted[n]) < kNear;
    }
    return is_near;
  }));
}

/// Of a color where half of what lies behind shines through.
Rgb halfOf(Rgb color, Rgb behind) { return blend(behind, color, 0.5); }

TEST(FigurePicture, ShowsSpheresByRadiusAndMarksInTheirColors) {
  const ToyPack objects{ToyObjects{}};
  const auto figures = figuresOf(*objects, {});
  ASSERT_TRUE(figures.has_value());
  EXPECT_EQ(radiiOf(*figures).size(), 2U);
  const Image object = drawFigure(figures->front(), 128);
  EXPECT_GT(pixelsLike(object, kBoxEdge), 100);
  EXPECT_GT(pixelsLike(object, sphereColor(0)), 50);
  EXPECT_GT(pixelsLike(object, halfOf(sphereColor(1), kMeshGray)), 50);
  EXPECT_EQ(pixelsLike(object, kFootprintMark), 0);

  const ToyPack robot{ToyRobot{}};
  const auto arm = figuresOf(*robot, {});
  ASSERT_TRUE(arm.has_value());
  const Image picture = drawFigure(arm->front(), 128);
  // Swatches of the legend alone have 196 pixels.
  constexpr int kSwatch = kTextHeight * kTextHeight;
  EXPECT_GT(pixelsLike(picture, kGraspMark), kSwatch);
  EXPECT_GT(pixelsLike(picture, kCameraMark), kSwatch);
  EXPECT_GT(pixelsLike(picture, kFootprintMark), kSwatch);
  // The mesh has its own color, red.
  EXPECT_GT(pixelsLike(picture, {255, 0, 0}), 200);
}

/// Pages and pictures are written in two languages, and mean the same by a color.
TEST(FigureColors, AreThoseOfPages) {
  const std::filesystem::path page = test::sourceFolder() / "view" / "page" / "src";
  std::string source;
  for (const auto& file : std::filesystem::directory_iterator(page)) {
    std::ifstream stream(file.path());
    source.append(std::istreambuf_iterator<char>(stream), {});
  }
  std::vector<Rgb> colors{kMeshGray,      kBoxEdge,    kGraspMark, kCameraMark,
                          kFootprintMark, kTargetMark, kGoalMark};
  colors.insert(colors.end(), kSphereColors.begin(), kSphereColors.end());
  for (const Rgb& color : colors) {
    const std::string hex = fmt::format("{:02x}{:02x}{:02x}", color.r, color.g, color.b);
    EXPECT_NE(source.find(hex), std::string::npos) << hex << " is in no source of the page";
  }
}

TEST(FigurePicture, HasFourViewsOfTheSizeAskedFor) {
  const ToyPack pack{ToyObjects{}};
  const auto figures = figuresOf(*pack, {});
  ASSERT_TRUE(figures.has_value());
  const Image small = drawFigure(figures->front(), 128);
  const Image large = drawFigure(figures->front(), 328);
  EXPECT_GE(small.width(), 4 * 128);
  EXPECT_EQ(large.height() - small.height(), 200);
}

TEST(FigurePicture, DrawsAFigureWithNothingInIt) {
  Figure nothing;
  nothing.name = "nothing";
  const Image image = drawFigure(nothing, 64);
  EXPECT_GT(image.width(), 4 * 64);
}

TEST(FigureWindow, HoldsEverythingDrawnInEachView) {
  const ToyPack pack{ToyObjects{}};
  const auto figures = figuresOf(*pack, {});
  ASSERT_TRUE(figures.has_value());
  const ViewWindow side = windowOf(figures->front(), kSideView);
  constexpr double kRounding = 1e-6;
  EXPECT_NEAR(side.low_right, -0.05, kRounding);
  EXPECT_NEAR(side.high_up, 0.1, kRounding);
  EXPECT_NEAR(side.extent(), 0.2, kRounding);
}

TEST(ContactSheet, HasATileForEachObject) {
  const ToyPack pack{ToyObjects{}};
  const auto figures = figuresOf(*pack, {});
  ASSERT_TRUE(figures.has_value());
  const auto sheet = drawContactSheet(*figures, 256);
  ASSERT_TRUE(sheet.has_value());
  EXPECT_GT(sheet->width(), 2 * 256);
  EXPECT_LT(sheet->height(), 2 * 256);
}

TEST(ContactSheet, HasRoomForNamesAndCaptions) {
  std::vector<Figure> figures(2);
  figures[0].name = "a_name_that_is_wider_than_the_view";
  figures[1].short_caption = {"a caption that is even wider than the name"};
  const auto sheet = drawContactSheet(figures, 64);
  ASSERT_TRUE(sheet.has_value());
  EXPECT_GE(sheet->width(), 2 * textWidth(figures[1].short_caption[0]));
  // Not for names without an end.
  figures[0].name.assign(10000, 'x');
  const auto bounded = drawContactSheet(figures, 64);
  ASSERT_TRUE(bounded.has_value());
  EXPECT_LT(bounded->width(), 2000);
}

TEST(ContactSheet, RefusesToBecomeHuge) {
  const std::vector<Figure> figures(10000);
  const auto sheet = drawContactSheet(figures, kLargestView);
  ASSERT_FALSE(sheet.has_value());
  EXPECT_EQ(sheet.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(sheet.error().message, HasSubstr("a sheet of 10000 objects at 2048 pixels each"));
}

}  // namespace
}  // namespace galactic::pictures::raster_test
