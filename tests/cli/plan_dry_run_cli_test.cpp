// What a dry run of a dataset or world says, as a user meets it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/plan_folder.h"
#include "support/mesh_files.h"

namespace galactic::test::plan_dry_run_cli_test {
namespace {

using testing::HasSubstr;

using PlanDryRun = PlanFolder;

TEST_F(PlanDryRun, EndsADryRunWithAnErrorWhenSomethingIsMissing) {
  const ProgramRun scene = bake("out", {"--dry-run", "-q"});
  EXPECT_EQ(scene.exit_code, 3);
  EXPECT_EQ(scene.out, "");
  EXPECT_EQ(
      scene.err,
      "galactic-bake: out/home.pack: something is missing in 2 of 6: e: stage 'hall' is in none "
      "of the dataset's paths; add it, or bake without it\n");
  EXPECT_THAT(report().at("missing").dump(), HasSubstr("scenes/d.pack"));
  EXPECT_FALSE(has("out"));
  const ProgramRun whole = bake("out", {"--dry-run", "--scenes", "a", "--scenes", "b"});
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_THAT(whole.out, HasSubstr("nothing is missing\n"));
}

/// One fetch is to be enough.
TEST_F(PlanDryRun, ListsAllUnreadableMeshesOfASceneInADryRun) {
  constexpr const char* kPointer = "version https://git-lfs.github.com/spec/v1\nsize 12345\n";
  write("data/meshes/apartment.glb", kPointer);
  write("data/meshes/objects/mug.glb", kPointer);
  const ProgramRun dry = bake("out", {"--dry-run", "--scenes", "a"});
  EXPECT_EQ(dry.exit_code, 3);
  const std::string missing = report().at("missing").dump();
  for (const char* mesh : {"meshes/apartment.glb", "meshes/objects/mug.glb"}) {
    EXPECT_THAT(missing, HasSubstr(std::string(mesh) + ": is a pointer of Git LFS"));
  }
}

/// What a dry run of a recipe says is missing, and its exit code.
struct DryRun {
  int exit_code = 0;
  std::string missing;
};

/// A bake would only warn of all of it: whoever wants to stop before has to know.
TEST_F(PlanDryRun, ListsMissingTexturesMaterialsAndMeshesInADryRun) {
  const auto dryRun = [&](const std::string& recipe) -> DryRun {
    write("parts.toml", "[bake]\nradii = [0.05]\n[[scenes]]\nfiles = \"flat.glb\"\n" + recipe);
    const ProgramRun dry = run({"parts.toml", "--dry-run", "-o", "x.pack", "--report", "r.json"});
    const auto report = nlohmann::json::parse(content("r.json"), nullptr, false);
    return {dry.exit_code, report.at("missing").dump()};
  };
  write("flat.glb", fileContent(sampleFile("apartment.glb")));
  write("pot.obj", test::objFile(test::unevenBox(), "mtllib pot.mtl\nusemtl m\n"));
  write("pot.mtl", "newmtl m\nKd 1 1 1\nmap_Kd nope.png\n");
  write("cup.obj", test::objFile(test::unevenBox(), "mtllib gone.mtl\nusemtl m\n"));
  const GltfPieces pieces{
      .nodes = GltfPieces{}.nodes,
      .buffer_uri = R"("uri":"jar.bin",)",
      .more =
          R"(,"materials":[{"name":"m","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])"
          R"(,"textures":[{"source":0}],"images":[{"uri":"gone.png"}])"};
  std::string jar = test::gltfFile(test::unevenBox(), pieces);
  const std::string_view primitive_end = R"("indices":0)";
  jar.insert(jar.find(primitive_end) + primitive_end.size(), R"(,"material":0)");
  write("jar.gltf", jar);
  write("jar.bin", test::gltfBuffer(test::unevenBox()));
  write("arm.stl", "version https://git-lfs.github.com/spec/v1\nsize 12345\n");
  write("cart.urdf", R"(<robot name="cart"><link name="base">
      <visual><geometry><mesh filename="pot.obj"/></geometry></visual>
      <visual><geometry><mesh filename="lid.dae"/></geometry></visual>
      <visual><geometry><mesh filename="arm.stl"/></geometry></visual>
      <collision><geometry><box size="0.4 0.4 0.4"/></geometry></collision></link></robot>)");

  EXPECT_EQ(dryRun("").exit_code, 0);
  const std::string pot =
      "pot.obj: texture 'nope.png' of material 'm' is missing: its surfaces keep their plain color";
  const DryRun objects = dryRun("[[objects]]\nfiles = [\"pot.obj\", \"cup.obj\", \"jar.gltf\"]\n");
  EXPECT_EQ(objects.exit_code, 3);
  EXPECT_THAT(objects.missing, HasSubstr(pot));
  EXPECT_THAT(
      objects.missing,
      HasSubstr("cup.obj: material file 'gone.mtl' is missing: its materials get default colors"));
  EXPECT_THAT(objects.missing,
              HasSubstr("jar.gltf: texture 'gone.png' of material 'm' is missing"));
  const DryRun robot = dryRun("[robot]\nfiles = \"cart.urdf\"\n");
  EXPECT_EQ(robot.exit_code, 3);
  EXPECT_THAT(robot.missing, HasSubstr(pot));
  EXPECT_THAT(robot.missing, HasSubstr("cart.urdf: mesh 'lid.dae' is missing: it is left out"));
  EXPECT_THAT(robot.missing,
              HasSubstr("cart.urdf: mesh 'arm.stl' does not load: is a pointer of "));

  // Of what a dataset's scene is composed of, too.
  write("data/meshes/pot.obj", content("pot.obj"));
  write("data/objects/pot.object_config.json", R"({"render_asset": "../meshes/pot.obj"})");
  addScene("p", "flat", thing("pot", 1));
  const ProgramRun scene = bake("out", {"--dry-run", "--scenes", "p", "--missing", "without"});
  EXPECT_EQ(scene.exit_code, 3);
  EXPECT_THAT(report().at("missing").dump(), HasSubstr("meshes/pot.obj: material file 'pot.mtl'"));
  EXPECT_EQ(bake("out", {"--scenes", "p", "--missing", "fail"}).exit_code, 0)
      << "the mesh is there";
}

}  // namespace
}  // namespace galactic::test::plan_dry_run_cli_test
