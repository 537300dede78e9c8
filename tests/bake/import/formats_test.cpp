// Every format's up axis and unit, and what overrides them.
#include <gmock/gmock.h>

#include "bake/import/import_helpers.h"

namespace galactic::test::formats_test {
namespace {

using bake::MeshImportOptions;
using bake::placeAndClean;
using bake::UpAxis;

/// World positions are rounded once, to float: half a unit in the last place at 8 m, and the files'
/// own floats add as much again.
constexpr double kFloatTolerance = 1e-6;

WorldPoint yUp(const std::array<float, 3>& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}
WorldPoint zUp(const std::array<float, 3>& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[2]), -static_cast<double>(p[1])};
}
WorldPoint xUp(const std::array<float, 3>& p) {
  return {-static_cast<double>(p[1]), static_cast<double>(p[0]), static_cast<double>(p[2])};
}
WorldPoint minusXUp(const std::array<float, 3>& p) {
  return {static_cast<double>(p[1]), -static_cast<double>(p[0]), static_cast<double>(p[2])};
}
WorldPoint minusYUp(const std::array<float, 3>& p) {
  return {static_cast<double>(p[0]), -static_cast<double>(p[1]), -static_cast<double>(p[2])};
}
WorldPoint minusZUp(const std::array<float, 3>& p) {
  return {static_cast<double>(p[0]), -static_cast<double>(p[2]), static_cast<double>(p[1])};
}

struct Case {
  std::string name;
  std::string content;
  Expected expected;
  double meters;
  std::string convention;
  MeshImportOptions options;
};

std::vector<WorldTriangle> scaled(std::vector<WorldTriangle> triangles, double factor) {
  for (WorldTriangle& triangle : triangles) {
    for (WorldPoint& p : triangle) {
      for (double& v : p) v *= factor;
    }
  }
  return triangles;
}

void expectBox(const Case& c) {
  SCOPED_TRACE(c.name + " as " + c.convention);
  const auto asset = importContent(c.name, c.content, c.options);
  ASSERT_TRUE(asset.has_value()) << asset.error().text();
  EXPECT_EQ(asset->convention, c.convention);
  const auto clean = placeAndClean(*asset);
  ASSERT_TRUE(clean.has_value()) << clean.error().message;
  EXPECT_EQ(clean->counts.degenerate + clean->counts.duplicate, 0U);
  const auto expected =
      inCanonicalOrder(scaled(expectedTriangles(unevenBox(), c.expected), c.meters));
  EXPECT_LE(largestDifference(worldTriangles(clean->mesh), expected), kFloatTolerance);
}

TEST(MeshFormats, ReadTheSameBoxFromEveryFormatByItsOwnConvention) {
  const MeshContent box = unevenBox();
  const std::string y_obj = "Y up (OBJ convention), 1 m per unit (OBJ convention)";
  const std::string y_gltf = "Y up (glTF convention), 1 m per unit (glTF convention)";
  const std::string z_ply = "Z up (PLY convention), 1 m per unit (PLY convention)";
  const std::string z_stl = "Z up (STL convention), 1 m per unit (STL convention)";
  expectBox({"box.obj", objFile(box), yUp, 1, y_obj, {}});
  expectBox({"box.glb", glbFile(box), yUp, 1, y_gltf, {}});
  expectBox({"ascii.ply", plyAsciiFile(box), zUp, 1, z_ply, {}});
  expectBox({"binary.ply", plyBinaryFile(box), zUp, 1, z_ply, {}});
  expectBox({"ascii.stl", stlAsciiFile(box), zUp, 1, z_stl, {}});
  expectBox({"binary.stl", stlBinaryFile(box), zUp, 1, z_stl, {}});
}

TEST(MeshFormats, GiveTheSameTrianglesWhenAllAreReadAsZUp) {
  const MeshContent box = unevenBox();
  const MeshImportOptions z{.up = UpAxis::kZ, .scale = 1.0, .transform = {}};
  const std::string forced = "Z up (`up`), 1 m per unit (`scale`)";
  expectBox({"box.obj", objFile(box), zUp, 1, forced, z});
  expectBox({"box.glb", glbFile(box), zUp, 1, forced, z});
  expectBox({"ascii.ply", plyAsciiFile(box), zUp, 1, forced, z});
  expectBox({"binary.ply", plyBinaryFile(box), zUp, 1, forced, z});
  expectBox({"ascii.stl", stlAsciiFile(box), zUp, 1, forced, z});
  expectBox({"binary.stl", stlBinaryFile(box), zUp, 1, forced, z});
  expectBox({"box.dae", daeFile(box, {"X_UP", "0.01", ""}), zUp, 1, forced, z});
  expectBox({"box.fbx", fbxFile(box, {0, 1, 1}), zUp, 1, forced, z});
}

TEST(MeshFormats, FollowTheUpAxisAndUnitOfEveryColladaFile) {
  struct Axis {
    std::string element;
    std::string name;
    Expected expected;
  };
  const std::vector<Axis> axes{
      {"X_UP", "X", xUp}, {"Y_UP", "Y", yUp}, {"Z_UP", "Z", zUp}, {"", "Y", yUp}};
  for (const Axis& axis : axes) {
    for (const std::string meter : {"1", "0.01", "0.0254", ""}) {
      const std::string unit = meter.empty() ? "1" : meter;
      expectBox({"box.dae",
                 daeFile(unevenBox(), {axis.element, meter, ""}),
                 axis.expected,
                 std::stod(unit),
                 fmt::format("{} up (file), {} m per unit (file)", axis.name, unit),
                 {}});
    }
  }
}

TEST(MeshFormats, SayWhetherTheirUnitIsStated) {
  const MeshContent box = unevenBox();
  const auto is_stated = [](std::string_view name, const std::string& file,
                            const bake::MeshImportOptions& options) {
    const auto asset = importContent(name, file, options);
    EXPECT_TRUE(asset.has_value()) << asset.error().text();
    return asset && asset->unit_is_stated;
  };
  EXPECT_TRUE(is_stated("box.dae", daeFile(box, {"Y_UP", "1", ""}), {}));
  EXPECT_TRUE(is_stated("box.fbx", fbxFile(box, {}), {}));
  for (const auto& [name, file] : std::vector<std::pair<std::string, std::string>>{
           {"box.obj", objFile(box)}, {"box.glb", glbFile(box)}, {"a.ply", plyAsciiFile(box)}}) {
    EXPECT_FALSE(is_stated(name, file, {})) << name;
    EXPECT_TRUE(is_stated(name, file, {.up = {}, .scale = 0.5, .transform = {}})) << name;
    EXPECT_FALSE(is_stated(name, file, {.up = UpAxis::kZ, .scale = {}, .transform = {}})) << name;
  }
}

TEST(MeshFormats, ReplaceTheColladaAxisOrUnitByAnOverrideAndKeepTheOther) {
  const std::string file = daeFile(unevenBox(), {"Z_UP", "0.01", ""});
  expectBox({"box.dae",
             file,
             yUp,
             0.01,
             "Y up (`up`), 0.01 m per unit (file)",
             {.up = UpAxis::kY, .scale = {}, .transform = {}}});
  expectBox({"box.dae",
             file,
             zUp,
             0.5,
             "Z up (file), 0.5 m per unit (`scale`)",
             {.up = {}, .scale = 0.5, .transform = {}}});
}

TEST(MeshFormats, FollowTheGlobalSettingsOfFbxFiles) {
  const MeshContent box = unevenBox();
  expectBox({"box.fbx", fbxFile(box, {1, 1, 100}), yUp, 1, "Y up (file), 1 m per unit (file)", {}});
  expectBox(
      {"box.fbx", fbxFile(box, {2, 1, 1}), zUp, 0.01, "Z up (file), 0.01 m per unit (file)", {}});
  expectBox({"box.fbx",
             fbxFile(box, {0, 1, 2.54}),
             xUp,
             0.0254,
             "X up (file), 0.0254 m per unit (file)",
             {}});
  expectBox({"box.fbx",
             fbxFile(box, {1, -1, 100}),
             minusYUp,
             1,
             "-Y up (file), 1 m per unit (file)",
             {}});
}

TEST(MeshFormats, TurnEveryUpAxisUpWithoutMirroring) {
  struct Axis {
    UpAxis up;
    std::string name;
    Expected expected;
  };
  const std::vector<Axis> axes{{UpAxis::kX, "X", xUp},
                               {UpAxis::kY, "Y", yUp},
                               {UpAxis::kZ, "Z", zUp},
                               {UpAxis::kMinusX, "-X", minusXUp},
                               {UpAxis::kMinusY, "-Y", minusYUp},
                               {UpAxis::kMinusZ, "-Z", minusZUp}};
  for (const Axis& axis : axes) {
    expectBox({"box.obj",
               objFile(unevenBox()),
               axis.expected,
               1,
               axis.name + " up (`up`), 1 m per unit (OBJ convention)",
               {.up = axis.up, .scale = {}, .transform = {}}});
  }
}

TEST(MeshFormats, ApplyTheTransformOverrideAfterAxesAndUnit) {
  // Z up and centimeters first; then 90 degrees about Y (x, y, z) -> (z, y, -x) and a shift.
  const bake::Affine turn{0, 0, 1, 5, 0, 1, 0, 6, -1, 0, 0, 7};
  const auto asset = importContent("box.ply", plyAsciiFile(unevenBox()),
                                   {.up = {}, .scale = 0.01, .transform = turn});
  ASSERT_TRUE(asset.has_value()) << asset.error().message;
  const auto clean = placeAndClean(*asset);
  ASSERT_TRUE(clean.has_value());
  const auto expected = expectedTriangles(unevenBox(), [](const std::array<float, 3>& p) {
    const WorldPoint upright = zUp(p);
    return WorldPoint{0.01 * upright[2] + 5, 0.01 * upright[1] + 6, -0.01 * upright[0] + 7};
  });
  EXPECT_LE(largestDifference(worldTriangles(clean->mesh), expected), kFloatTolerance);
}

TEST(MeshFormats, TriangulateConcavePolygons) {
  // An L of area 3 in the ground plane.
  const auto asset = importContent(
      "l.obj", "v 0 0 0\nv 2 0 0\nv 2 0 1\nv 1 0 1\nv 1 0 2\nv 0 0 2\nf 1 2 3 4 5 6\n");
  ASSERT_TRUE(asset.has_value()) << asset.error().message;
  const auto clean = placeAndClean(*asset);
  ASSERT_TRUE(clean.has_value());
  double area = 0;
  for (const WorldTriangle& t : worldTriangles(clean->mesh)) {
    area += 0.5 * std::abs((t[1][0] - t[0][0]) * (t[2][2] - t[0][2]) -
                           (t[2][0] - t[0][0]) * (t[1][2] - t[0][2]));
  }
  EXPECT_EQ(clean->mesh.triangles.size(), 4U);
  EXPECT_NEAR(area, 3, kFloatTolerance);
}

TEST(MeshFormats, KeepExtensionsInCapitalsReadable) {
  expectBox({"BOX.OBJ",
             objFile(unevenBox()),
             yUp,
             1,
             "Y up (OBJ convention), 1 m per unit (OBJ convention)",
             {}});
  expectBox({"BOX.GLB",
             glbFile(unevenBox()),
             yUp,
             1,
             "Y up (glTF convention), 1 m per unit (glTF convention)",
             {}});
}

}  // namespace
}  // namespace galactic::test::formats_test
