// What info, diff, check and export make of render meshes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "pack_tool/asset_packs.h"
#include "pack_tool/describe/info_text.h"
#include "pack_tool/figure/figures_of_pack.h"
#include "pack_tool/mesh/figure_glb.h"
#include "pack_tool/painted_meshes.h"
#include "pack_tool/verbs/verbs.h"
#include "support/pack_tool_fixture.h"
#include "support/packs/texture_pack_builder.h"
#include "view/render_surfaces.h"

namespace galactic::pack_tool::render_meshes_test {
namespace {

using test::paintedMeshes;
using test::Painting;
using test::ScratchFolder;
using test::ToyObjects;
using test::ToyPack;
using test::ToyRobot;
using testing::HasSubstr;
using testing::Not;

/// Exit code of invalid input.
constexpr int kInvalid = 3;

struct Answer {
  int exit_code = 0;
  std::string out;
  std::string err;
};

template <class Verb, class Options>
Answer answerOf(Verb verb, const Options& options) {
  std::ostringstream out;
  std::ostringstream err;
  const int exit_code = verb(options, Console{out, err});
  return {exit_code, out.str(), err.str()};
}

std::filesystem::path writeScene(const ScratchFolder& folder, std::string_view name,
                                 const test::RenderMeshesField& meshes) {
  test::ScenePackFields scene = test::kitchenScene();
  scene.render_meshes = meshes;
  return writePack(folder, name, scene);
}

Json describedScene(const Painting& painting) {
  const ScratchFolder folder;
  const auto pack =
      PackFile::open(writeScene(folder, "a.pack", paintedMeshes(painting)), Trust::kVerify);
  EXPECT_TRUE(pack.has_value());
  return describePack(*pack);
}

Answer diffOf(const test::RenderMeshesField& a, const test::RenderMeshesField& b,
              DiffOptions options = {}) {
  const ScratchFolder folder;
  options.a = writeScene(folder, "a.pack", a);
  options.b = writeScene(folder, "b.pack", b);
  return answerOf(runDiff, options);
}

TEST(DescribeRenderMeshes, TellsSumsModelsMaterialsAndTextures) {
  const Json render = describedScene({.colored = true}).at("render_meshes");
  EXPECT_EQ(render.at("clusters"), 3);
  EXPECT_EQ(render.at("two_sided_clusters"), 1);
  EXPECT_EQ(render.at("vertices"), 12);
  EXPECT_EQ(render.at("triangles"), 6);
  EXPECT_EQ(render.at("source_triangles"), 50);
  EXPECT_EQ(render.at("largest_error"), 0.004);
  EXPECT_EQ(render.at("colored"), true);
  EXPECT_EQ(render.at("texture_bytes"), 1364 + 340);
  const Json& model = render.at("models").at(0);
  EXPECT_EQ(model.at("name"), "kitchen");
  EXPECT_EQ(model.at("bounds"), Json::parse(R"({"min": [0.0, 0.0, 0.0], "max": [2.0, 1.0, 1.0]})"));
  EXPECT_EQ(render.at("materials").at(0),
            Json::parse(R"({"name": "wood", "color": "#808080ff", "texture": "wood.png",
                            "alpha_cutoff": 0.0})"));
  EXPECT_EQ(render.at("materials").at(2).at("color"), "#c04020ff");
  EXPECT_TRUE(render.at("materials").at(2).at("texture").is_null());
  const Json& texture = render.at("textures").at(1);
  EXPECT_EQ(texture.at("name"), "leaf.png");
  EXPECT_EQ(texture.at("size"), 8);
  EXPECT_EQ(texture.at("format"), "rgba8");
  EXPECT_EQ(texture.at("bytes"), 340);
  EXPECT_EQ(render.at("semantics"), Json::parse(R"(["wall", "plant", "floor"])"));
}

TEST(DescribeRenderMeshes, NamesModelsAsTheirObjectsAndLinks) {
  ToyObjects toys;
  toys.render_meshes = paintedMeshes({.parts = {1}});
  const ToyPack objects{toys};
  EXPECT_EQ(describePack(*objects).at("render_meshes").at("models").at(0).at("name"), "die");
  ToyRobot arm;
  arm.render_meshes = paintedMeshes({.parts = {0, 4}});
  const ToyPack robot{arm};
  EXPECT_EQ(describePack(*robot).at("render_meshes").at("models").at(1).at("name"), "head");
}

TEST(InfoText, SumsUpRenderMeshes) {
  const std::string text = infoText(describedScene({.bc1 = true}));
  EXPECT_THAT(text,
              HasSubstr("  render       1 model, 3 clusters (33 % two-sided), 12 vertices, "));
  EXPECT_THAT(text, HasSubstr("               6 of 50 triangles, moved by at most 4.00 mm\n"));
  EXPECT_THAT(text,
              HasSubstr("  materials    3, 1 with a cut-out shape; vertices have no colors\n"));
  EXPECT_THAT(text, HasSubstr("  textures     2, 524 bytes: 1 of 16 texels (bc1), 1 of 8 texels "
                              "(rgba8)\n"));
  EXPECT_THAT(text, HasSubstr("  semantics    3 names\n"));
}

TEST(InfoText, ListsTheModelsOfARobot) {
  ToyRobot arm;
  arm.render_meshes = paintedMeshes({.parts = {0, 4}});
  const ToyPack robot{arm};
  const std::string text = infoText(describePack(*robot));
  EXPECT_THAT(text,
              HasSubstr("\n    head          3       33 %        12          6  50        4.00\n"));
}

TEST(InfoText, SaysThatThereAreNoRenderMeshes) {
  const ToyPack pack{ToyObjects{}};
  EXPECT_TRUE(describePack(*pack).at("render_meshes").is_null());
  EXPECT_THAT(infoText(describePack(*pack)), HasSubstr("  render       no render meshes"));
}

TEST(RenderDiff, FindsEqualMeshesEqual) {
  const Answer same = diffOf(paintedMeshes(), paintedMeshes());
  EXPECT_EQ(same.exit_code, kExitOk) << same.out;
}

TEST(RenderDiff, MeasuresMovedVerticesAgainstTheTolerance) {
  const Answer moved = diffOf(paintedMeshes(), paintedMeshes({.front = 1.25F}));
  EXPECT_EQ(moved.exit_code, kExitDiffers);
  EXPECT_THAT(moved.out, HasSubstr("content (A | B)\n"));
  EXPECT_THAT(moved.out, HasSubstr("  render_meshes.models.kitchen.bounds.max.2: 1.0 | 1.25\n"));
  EXPECT_THAT(moved.out, HasSubstr("  render_meshes.models.kitchen.places: 12 | 12, 2 moved by up "
                                   "to 0.25 m\n"));
  const Answer near = diffOf(paintedMeshes(), paintedMeshes({.front = 1.25F}), {.tolerance = 0.3});
  EXPECT_EQ(near.exit_code, kExitOk) << near.out;
}

TEST(RenderDiff, ComparesTexturesByTheirTexels) {
  const Answer other = diffOf(paintedMeshes(), paintedMeshes({.seed = 4}));
  EXPECT_EQ(other.exit_code, kExitDiffers);
  EXPECT_THAT(other.out, HasSubstr("  render_meshes.textures.wood.png.fnv1a_64: "));
  EXPECT_THAT(other.out, HasSubstr("  render_meshes.textures.leaf.png.fnv1a_64: "));
  EXPECT_THAT(other.out, Not(HasSubstr(".places")));
}

/// The painted meshes with the texture of the wood in a pack of its own.
test::RenderMeshesFields withSharedWood(const test::TexelHash& hash) {
  test::RenderMeshesFields meshes = *paintedMeshes();
  meshes.textures[0].shared = hash;
  meshes.textures[0].first_byte = 0;
  meshes.texels.erase(meshes.texels.begin(), meshes.texels.begin() + meshes.textures[1].first_byte);
  meshes.textures[1].first_byte = 0;
  return meshes;
}

TEST(DescribeRenderMeshes, NamesTheTexturesThatAreInPacksOfTheirOwn) {
  const ScratchFolder folder;
  const auto path = writeScene(folder, "a.pack", withSharedWood({2, 1}));
  const auto pack = PackFile::open(path, Trust::kVerify);
  ASSERT_TRUE(pack.has_value()) << pack.error().text();
  const Json description = describePack(*pack);
  const Json& render = description.at("render_meshes");
  EXPECT_EQ(render.at("materials").at(0).at("texture"), "wood.png");
  EXPECT_EQ(render.at("textures").at(0).at("shared"), "00000000000000010000000000000002");
  EXPECT_TRUE(render.at("textures").at(0).at("fnv1a_64").is_null());
  EXPECT_TRUE(render.at("textures").at(1).at("shared").is_null());
  EXPECT_EQ(render.at("texture_bytes"), 340);
  EXPECT_THAT(infoText(description), HasSubstr("  textures     2, 340 bytes: 1 of 16 texels "
                                               "(rgba8), 1 of 8 texels (rgba8); 1 in texture "
                                               "packs\n"));
}

TEST(RenderDiff, ComparesTexturesInPacksOfTheirOwnByTheirHash) {
  const Answer other =
      diffOf(withSharedWood({2, 1}), withSharedWood({3, 1}), {.scope = DiffScope::kContent});
  EXPECT_EQ(other.exit_code, kExitDiffers);
  EXPECT_THAT(other.out, HasSubstr("  render_meshes.textures.wood.png.shared: "
                                   "00000000000000010000000000000002 | "
                                   "00000000000000010000000000000003\n"));
}

TEST(TexturePacks, AreDescribedAndCompared) {
  const ScratchFolder folder;
  const test::TexturePackFields oak;
  test::TexturePackFields ash;
  ash.name = "ash";
  ash.texels.back() = 7;
  const auto oak_pack = folder.write("oak.pack", test::textOf(buildPack(oak)));
  const auto ash_pack = folder.write("ash.pack", test::textOf(buildPack(ash)));
  InfoOptions of_oak;
  of_oak.packs = {oak_pack};
  const Answer info = answerOf(runInfo, of_oak);
  const auto [low, high] = test::hashOf(oak.texels);
  EXPECT_THAT(info.out, HasSubstr(fmt::format("  texture      oak, 2 texels (rgba8), 20 bytes, "
                                              "XXH3-128 {:016x}{:016x}\n",
                                              high, low)));
  const Answer same = answerOf(runDiff, DiffOptions{.a = oak_pack, .b = oak_pack});
  EXPECT_EQ(same.exit_code, kExitOk) << same.err;
  const Answer other = answerOf(runDiff, DiffOptions{.a = oak_pack, .b = ash_pack});
  EXPECT_EQ(other.exit_code, kExitDiffers) << other.err;
  EXPECT_THAT(other.out, HasSubstr("content (A | B)\n  name: oak | ash\n"));
  EXPECT_THAT(other.out, HasSubstr("  xxh3_128: "));
}

TEST(RenderDiff, TellsOtherMaterialsAndColors) {
  const Answer renamed = diffOf(paintedMeshes(), paintedMeshes({.paint = "varnish"}));
  EXPECT_EQ(renamed.exit_code, kExitDiffers);
  EXPECT_THAT(renamed.out,
              HasSubstr("  render_meshes.materials.varnish.color: none | #c04020ff\n"));
  EXPECT_THAT(renamed.out,
              HasSubstr("  render_meshes.models.kitchen.clusters: 3 | 3, 1 with other triangles, "
                        "materials or sides\n"));
  const Answer colored = diffOf(paintedMeshes(), paintedMeshes({.colored = true}));
  EXPECT_EQ(colored.exit_code, kExitDiffers);
  EXPECT_THAT(colored.out, HasSubstr("  render_meshes.models.kitchen.colors: 12 | 12, 6 others\n"));
}

TEST(RenderDiff, CountsHowTheyWereMadeAsProvenance) {
  const Painting coarser{.largest_error = 0.006F};
  const Answer all = diffOf(paintedMeshes(), paintedMeshes(coarser));
  EXPECT_EQ(all.exit_code, kExitDiffers);
  EXPECT_THAT(all.out,
              HasSubstr("provenance (A | B)\n  render_meshes.largest_error: 0.004 | 0.006\n"));
  const Answer content =
      diffOf(paintedMeshes(), paintedMeshes(coarser), {.scope = DiffScope::kContent});
  EXPECT_EQ(content.exit_code, kExitOk) << content.out;
}

TEST(RenderDiff, TellsThatOneSideHasNone) {
  const Answer gone = diffOf(paintedMeshes(), {});
  EXPECT_EQ(gone.exit_code, kExitDiffers);
  EXPECT_THAT(gone.out, HasSubstr("  render_meshes: present | none\n"));
}

TEST(CheckRenderMeshes, NamesTheWrongValue) {
  test::RenderMeshesField damaged = paintedMeshes();
  damaged->clusters[1].material = 9;
  const ScratchFolder folder;
  const auto path = writeScene(folder, "a.pack", damaged);
  const Answer answer = answerOf(runCheck, CheckOptions{.packs = {path}});
  EXPECT_EQ(answer.exit_code, kInvalid);
  EXPECT_THAT(answer.err, HasSubstr("clusters[1]"));
  EXPECT_THAT(answer.err, HasSubstr("material"));
}

TEST(RenderSurfaces, AreWhatTheMeshesWereMadeOf) {
  const RenderMeshStorage storage = test::paintedStorage({.colored = true});
  const RenderMeshes meshes = storage.view();
  const auto surfaces = surfacesOf(meshes, meshes.models.front());
  ASSERT_EQ(surfaces.size(), 3U);
  const RenderSurface& floor = surfaces[2];
  EXPECT_EQ(floor.material, 2);
  EXPECT_EQ(floor.semantic, 2);
  EXPECT_FALSE(floor.two_sided);
  EXPECT_TRUE(surfaces[1].two_sided);
  EXPECT_EQ(floor.corners, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(floor.vertices[1].position, (Vec3{2, 0, 1}));
  EXPECT_NEAR(floor.vertices[1].u, 2, 1e-6);
  EXPECT_NEAR(floor.vertices[1].v, 1, 1e-6);
  EXPECT_EQ(floor.vertices[3].color, 0xFF6080A0U);
}

TEST(SceneExport, NeedsRenderMeshes) {
  const ScratchFolder folder;
  const auto path = writeScene(folder, "a.pack", {});
  const Answer answer =
      answerOf(runExport, ExportOptions{.pack = path, .output = folder.path() / "a.glb"});
  EXPECT_EQ(answer.exit_code, kInvalid);
  EXPECT_THAT(answer.err, HasSubstr("has no render meshes, only column grids; "));
}

TEST(SceneExport, RefusesOptionsOfObjects) {
  const ScratchFolder folder;
  const auto path = writeScene(folder, "a.pack", paintedMeshes());
  const Answer answer =
      answerOf(runExport, ExportOptions{.pack = path,
                                        .output = folder.path() / "a.glb",
                                        .figures = FigureOptions{.object = "mug"}});
  EXPECT_EQ(answer.exit_code, kInvalid);
  EXPECT_THAT(answer.err, HasSubstr("is a scene; --object, --joints and --all-zero are for "));
}

TEST(Picture, NamesAllKindsThatItDraws) {
  const ScratchFolder folder;
  const auto path =
      folder.write("wood.pack", test::textOf(test::buildPack(test::TexturePackFields{})));
  const Answer answer =
      answerOf(runPicture, PictureOptions{.pack = path, .output = folder.path() / "a.png"});
  EXPECT_EQ(answer.exit_code, kInvalid);
  EXPECT_THAT(answer.err, HasSubstr("expected a scene (SCEN), objects (OBJS), a robot (RBOT), "
                                    "episodes (EPIS) or a world (WRLD)"));
}

TEST(ScenePicture, ShowsTheMeshesWhenAskedTo) {
  const ScratchFolder folder;
  const auto path = writeScene(folder, "a.pack", paintedMeshes());
  PictureOptions options{.pack = path, .output = folder.path() / "a.png", .size = 64};
  options.figures.emplace();
  options.grids.radius = 0.5F;
  const Answer both = answerOf(runPicture, options);
  EXPECT_EQ(both.exit_code, kInvalid);
  EXPECT_THAT(both.err, HasSubstr("a picture is either of its grids, "));
  options.grids.radius.reset();
  const Answer drawn = answerOf(runPicture, options);
  EXPECT_EQ(drawn.exit_code, kExitOk) << drawn.err;
  EXPECT_TRUE(std::filesystem::exists(options.output));
}

}  // namespace
}  // namespace galactic::pack_tool::render_meshes_test
