// Figures of packs come back from the cache as they went in, and reports hold no less of them.
#include "json/figure_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace galactic::test::figure_json_test {
namespace {

using bake::OrderedJson;
using bake::PackFigures;
using testing::HasSubstr;

bake::RenderFigures renderFigures() {
  bake::RenderFigures figures{.textures = 2, .shared_textures = {{"0a", "0b"}}};
  figures.all = {.source_triangles = 900,
                 .triangles = 400,
                 .source_vertices = 700,
                 .vertices = 300,
                 .clusters = 12,
                 .two_sided_triangles = 7,
                 .source_bytes = 9000,
                 .bytes = 4000,
                 .source_texture_bytes = 1 << 20,
                 .texture_bytes = 1 << 18,
                 .largest_error = 0.0048F};
  figures.models = {{.part = 3,
                     .step = 0.25F,
                     .source_triangles = 900,
                     .triangles = 400,
                     .clusters = 12,
                     .largest_error = 0.0048F}};
  return figures;
}

bake::SphereFigures sphereFigures() {
  return {.count = 9,
          .count_per_radius = {2, 3, 4},
          .quality = {.gap = {0.001, 0.002, 0.003},
                      .protrusion = {0.004, 0.005, 0.006},
                      .volume_ratio = 1.25,
                      .thin_points = 5,
                      .samples = 800},
          .guaranteed_gap = 0.016,
          .guaranteed_protrusion = 0.021,
          .meets_tolerances = false};
}

bake::SceneFigures sceneFigures() {
  bake::GridFigures grid{.radius = 0.05F,
                         .spacing = 0.03F,
                         .columns = {120, 80},
                         .raw_spans = 50,
                         .spans = 40,
                         .max_spans_per_column = 3,
                         .overflow_columns = 2,
                         .merged_gaps = 6,
                         .slivers = 1,
                         .stored_bytes = 1234,
                         .parts = 4};
  grid.regions[1] = {.components = 2, .spans = 11, .volume = 3.5};
  grid.cast_check = bake::CastCheck{.columns = 128, .columns_differing = 1, .compared = 9.5};
  grid.largest_parts = {{bake::Region::kOutside, 3.5, {{-1, 0, -2}, {1, 2, 3}}}};
  return {.input = "room.glb",
          .imported = {.format = "glTF 2.0",
                       .meshes = 3,
                       .instances = 4,
                       .counts = {.read = 12, .degenerate = 1, .duplicate = 2},
                       .triangles = 9},
          .convention = "Y up, meters; give `up`",
          .bounds = {{-1, 0, -2}, {1, 2.5F, 3}},
          .seconds = {.import = 0.5, .write = 0.25},
          .warnings = {"a part is left out; give `inside`"},
          .render_meshes = renderFigures(),
          .grids = {grid}};
}

bake::ObjectSetFigures objectFigures() {
  bake::ObjectFigures mug{.input = "mug.obj", .name = "mug", .spheres = sphereFigures()};
  mug.box.used = bake::BoxFit::kAxisAligned;
  mug.box.box.half_extents = {0.1F, 0.2F, 0.3F};
  mug.box.volume = 0.048;
  mug.authored_spheres = true;
  mug.stable_poses = {{.rotation = {0.5F, 0.5F, -0.5F, 0.5F}, .height = 0.1F, .likelihood = 0.75F}};
  mug.seconds = {.import = 1, .bake = {.box = 2, .spheres = 3}};
  mug.warnings = {"has thin parts"};
  return {.radii = {0.015F, 0.05F}, .objects = {mug}, .warnings = {"odd"}, .seconds = 6};
}

bake::RobotFigures robotFigures() {
  return {.input = "arm.urdf",
          .name = "arm",
          .links = 5,
          .joint_positions = 4,
          .controlled_joints = 3,
          .groups = {{"hand", {"hand", "finger"}, true, 0.02F, 0.04F, sphereFigures(), true},
                     {"cover", {"cover"}, false, 0.02F, 0.04F, sphereFigures(), false}},
          .pairs = {{"hand", "cover", PairKind::kNever}},
          .meshes = {"hand.stl: found"},
          .seconds = {.import = 1, .bake = {.spheres = 2}, .write = 0.5, .all = 4},
          .warnings = {"no laser"}};
}

bake::EpisodeFigures episodeFigures() {
  bake::EpisodeGeneration generation;
  generation.scenes.emplace_back().name = "room";
  generation.scenes.front().skipped = 2;
  generation.left_out = {{"cellar", "it is dark"}};
  generation.sample = {.episodes = 4, .solved = 3, .unsolved = {{"x", 1}}};
  generation.skipped = 2;
  generation.with_fewer_objects = 1;
  generation.rejections[bake::EpisodeRejection::kTipped] = 17;
  generation.scenes.front().shortened_way = 0.5F;
  return {.input = "2 scenes",
          .name = "home",
          .robot = "fetch",
          .episodes = 7,
          .placements = 30,
          .most_placements = 5,
          .scenes = {"room"},
          .objects = {"mug"},
          .start_joints = {"elbow"},
          .target_to_goal = {1, 2, 3},
          .seconds = 8,
          .warnings = {"one place only"},
          .generation = generation};
}

std::vector<PackFigures> allFigures() {
  return {{"room.pack", 1, sceneFigures()},
          {"mug.pack", 2, objectFigures()},
          {"arm.pack", 3, robotFigures()},
          {"home.pack", 4, episodeFigures()}};
}

std::string plain(const std::string& sentence) { return sentence; }

TEST(FigureJson, ComesBackFromTheCacheAsItWentIn) {
  ASSERT_EQ(allFigures().size(), 4U);
  for (const PackFigures& figures : allFigures()) {
    SCOPED_TRACE(figures.output);
    const OrderedJson json = jsonOf(figures);
    PackFigures read;
    ASSERT_TRUE(readFigures(OrderedJson::parse(json.dump()), read));
    EXPECT_EQ(jsonOf(read), json);
    EXPECT_EQ(reportEntries(read, plain), reportEntries(figures, plain));
    EXPECT_EQ(warningsOf(read), warningsOf(figures));
    EXPECT_EQ(sharedTexturesOf(read), sharedTexturesOf(figures));
  }
}

/// The members of an object, those of the objects in it, and of the first element of lists.
std::vector<OrderedJson::json_pointer> membersIn(const OrderedJson& json,
                                                 const OrderedJson::json_pointer& at) {
  std::vector<OrderedJson::json_pointer> members;
  const OrderedJson& here = json.at(at);
  for (auto one = here.begin(); here.is_object() && one != here.end(); ++one) {
    const auto place = at / one.key();
    members.push_back(place);
    const auto inner = membersIn(json, place);
    members.insert(members.end(), inner.begin(), inner.end());
  }
  if (here.is_array() && !here.empty()) return membersIn(json, at / std::size_t{0});
  return members;
}

TEST(FigureJson, IsRefusedOrDiffersWithoutAnyOneOfItsMembers) {
  std::size_t refused = 0;
  std::size_t differing = 0;
  for (const PackFigures& figures : allFigures()) {
    const OrderedJson json = jsonOf(figures);
    for (const auto& member : membersIn(json, OrderedJson::json_pointer())) {
      SCOPED_TRACE(member.to_string());
      OrderedJson damaged = json;
      damaged.at(member.parent_pointer()).erase(member.back());
      PackFigures read;
      try {
        if (!readFigures(damaged, read))
          ++refused;
        else {
          EXPECT_NE(jsonOf(read), json);
          ++differing;
        }
      } catch (const OrderedJson::exception&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 100U);
  EXPECT_GT(differing, 3U) << "what is optional";
}

TEST(FigureWarnings, SayWhenFewerThanFourInFiveEpisodesCanBeSolved) {
  EXPECT_THAT(bake::warningsOf({"home.pack", 4, episodeFigures()}),
              testing::ElementsAre("one place only",
                                   "the scripted policy solves 3 of 4 episodes, less than 80 %: "
                                   "robot, scenes and `heights` may not suit each other"));
  for (const bake::SolvedSample& enough :
       {bake::SolvedSample{.episodes = 5, .solved = 4, .unsolved = {{"x", 1}}},
        bake::SolvedSample{}}) {
    bake::EpisodeFigures set = episodeFigures();
    set.generation->sample = enough;
    EXPECT_THAT(bake::warningsOf({"home.pack", 4, set}), testing::ElementsAre("one place only"));
  }
}

TEST(FigureReports, RephraseSentencesAndLeaveOutDetails) {
  const auto loud = [](const std::string& sentence) { return sentence + "!"; };
  const OrderedJson entries = reportEntries(allFigures().front(), loud);
  ASSERT_EQ(entries.size(), 1U);
  const OrderedJson& entry = entries.front();
  EXPECT_EQ(entry["input"], "room.glb");
  EXPECT_EQ(entry["output"], "room.pack");
  EXPECT_EQ(entry["pack_bytes"], 1);
  EXPECT_EQ(entry["convention"], "Y up, meters; give `up`!");
  EXPECT_EQ(entry["warnings"][0], "a part is left out; give `inside`!");
  EXPECT_EQ(entry["grids"][0]["regions"]["outside"]["spans"], 11);
  EXPECT_THAT(jsonOf(allFigures().front()).dump(), HasSubstr("stored_bytes"));
  EXPECT_THAT(entries.dump(), testing::Not(HasSubstr("stored_bytes")));
}

TEST(FigureReports, HaveAnEntryForEachObjectAndSpheresOfMeasuredGroupsOnly) {
  bake::ObjectSetFigures two = objectFigures();
  two.objects.push_back(two.objects.front());
  two.objects.back().name = "pan";
  const OrderedJson objects = reportEntries(PackFigures{"two.pack", 5, two}, plain);
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[1]["name"], "pan");
  EXPECT_FALSE(objects[1].contains("fit"));
  const OrderedJson robot =
      reportEntries(PackFigures{"arm.pack", 3, robotFigures()}, plain).front();
  EXPECT_TRUE(robot["groups"][0].contains("spheres"));
  EXPECT_FALSE(robot["groups"][1].contains("spheres"));
  EXPECT_EQ(robot["pairs"][0]["kind"], "never");
}

}  // namespace
}  // namespace galactic::test::figure_json_test
