// The options of galactic-bake for render meshes as a user meets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/bake_folder.h"
#include "galactic/pack.h"
#include "galactic/render_meshes.h"
#include "support/file_content.h"
#include "support/mesh_files.h"

namespace galactic::bake_render_cli_test {
namespace {

using nlohmann::json;
using test::ProgramRun;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class BakeRenderCli : public test::BakeFolder {
 protected:
  [[nodiscard]] ProgramRun bake(std::vector<std::string> arguments) const {
    const std::vector<std::string> quick{"--as",      "object", "--scale", "0.03",  "--radii",
                                         "0.03,0.05", "--eps",  "0.02",    "--tau", "0.03"};
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    return run(std::move(arguments));
  }

  [[nodiscard]] std::optional<std::size_t> modelsIn(const std::string& pack_name) const {
    const auto pack = PackFile::open(path(pack_name));
    EXPECT_TRUE(pack) << pack.error().text();
    const auto meshes = renderMeshesOf(*pack);
    EXPECT_TRUE(meshes);
    if (!*meshes) return std::nullopt;
    return (*meshes)->models.size();
  }
};

TEST_F(BakeRenderCli, MakesRenderMeshesByDefaultAndReportsThem) {
  write("brick.obj", test::objFile(test::unevenBox()));
  const ProgramRun run = bake({"brick.obj", "--report", "report.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("render meshes: 12 -> 12 triangles (0 two-sided)"),
                             HasSubstr("0 textures: 0.00 -> 0.00 MB")));
  EXPECT_EQ(modelsIn("brick.pack"), 1U);
  const json report = json::parse(test::fileContent(path("report.json")));
  const json& meshes = report.at("baked").at(0).at("render_meshes");
  EXPECT_EQ(meshes.at("source_triangles"), 12);
  EXPECT_EQ(meshes.at("triangles"), 12);
  EXPECT_EQ(meshes.at("models").at(0).at("clusters"), 1);
  EXPECT_EQ(meshes.at("texture_bytes"), 0);
}

TEST_F(BakeRenderCli, LeavesThemOutWhenAsked) {
  write("brick.obj", test::objFile(test::unevenBox()));
  const ProgramRun run = bake({"brick.obj", "--no-render-meshes"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, Not(HasSubstr("render meshes")));
  EXPECT_EQ(modelsIn("brick.pack"), std::nullopt);
}

TEST_F(BakeRenderCli, BakesLightIntoVertexColorsUnlessToldNotTo) {
  write("brick.obj", test::objFile(test::unevenBox()));
  ASSERT_EQ(bake({"brick.obj", "-o", "auto.pack"}).exit_code, 0);
  ASSERT_EQ(bake({"brick.obj", "-o", "all.pack", "--lighting", "all"}).exit_code, 0);
  ASSERT_EQ(bake({"brick.obj", "-o", "none.pack", "--lighting", "none"}).exit_code, 0);
  const auto colors_in = [&](const char* name) {
    const auto pack = PackFile::open(path(name));
    EXPECT_TRUE(pack);
    return (*renderMeshesOf(*pack))->colors.size();
  };
  EXPECT_EQ(colors_in("none.pack"), 0U);
  EXPECT_GE(colors_in("auto.pack"), 24U);
  EXPECT_GE(colors_in("all.pack"), 24U);
}

TEST_F(BakeRenderCli, RefusesLightingThatIsNone) {
  write("brick.obj", test::objFile(test::unevenBox()));
  for (const char* wrong : {"", "baked", "yes", "auto,all", "3"}) {
    const ProgramRun run = bake({"brick.obj", "--lighting", wrong});
    EXPECT_EQ(run.exit_code, 1) << wrong;
    EXPECT_THAT(run.err, HasSubstr("--lighting")) << wrong;
  }
  const ProgramRun run = bake({"brick.obj", "--lighting", "none", "--no-render-meshes"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("--lighting: does not go with --no-render-meshes"));
}

TEST_F(BakeRenderCli, RefusesErrorsAndSizesThatAreNone) {
  write("brick.obj", test::objFile(test::unevenBox()));
  const std::vector<std::pair<std::vector<std::string>, std::string>> refused{
      {{"--render-error", "-1"}, "--render-error: found -1, expected a number from 0 to 10000"},
      {{"--render-error", "big"}, "--render-error"},
      {{"--texture-size", "300"}, "--texture-size"},
      {{"--texture-format", "png"}, "--texture-format"}};
  for (const auto& [options, message] : refused) {
    std::vector<std::string> arguments{"brick.obj"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramRun run = bake(arguments);
    EXPECT_EQ(run.exit_code, 1) << message;
    EXPECT_THAT(run.err, HasSubstr(message));
  }
}

TEST_F(BakeRenderCli, DoesNotTakeThemForEpisodes) {
  write("a.pack", "");
  const ProgramRun run = this->run({"a.pack", "--as", "episodes", "--no-render-meshes"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("does not go with --as episodes"));
}

}  // namespace
}  // namespace galactic::bake_render_cli_test
