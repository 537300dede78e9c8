// Episodes in the worlds of recipes: what a dataset annotates, and scenes that cannot be used.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <system_error>
#include <thread>

#include "cli/plan_folder.h"
#include "galactic/error.h"
#include "galactic/world.h"
#include "support/build_paths.h"
#include "support/recipe_text.h"

namespace galactic::test::plan_episodes_cli_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;

/// Scene c is the apartment, well a shaft that is too narrow to stand in.
class PlanEpisodes : public PlanFolder {
 protected:
  void SetUp() override {
    PlanFolder::SetUp();
    write("data/meshes/well.obj", R"(v 0 0 0
v 0.5 0 0
v 0 2 0
v 0.5 2 0
v 0 0 0.5
v 0.5 0 0.5
v 0 2 0.5
v 0.5 2 0.5
f 1 2 4 3
f 5 7 8 6
f 1 5 6 2
f 3 4 8 7
f 1 3 7 5
f 2 6 8 4
)");
    write("data/stages/well.stage_config.json", R"({"render_asset": "../meshes/well.obj"})");
    addScene("well", "well", "");
    annotate(-2.5);
  }

  /// Marks all of the apartment that lies within 1.5 m of this x as a receptacle, and another one
  /// wrongly.
  void annotate(double x) {
    write("data/stages/flat.stage_config.json",
          fmt::format(R"({{"render_asset": "../meshes/apartment.glb", "user_defined": {{
              "receptacle_aabb_part": {{"position": [{}, 0.7, 0], "scale": [1.5, 0.7, 4]}},
              "receptacle_aabb_bad": {{"position": [0, 0, 0]}}}}}})",
                      x));
  }

  [[nodiscard]] ProgramRun bakeWorld(const std::string& scenes, const std::string& supports) {
    write("flat.toml",
          test::quickRecipe(
              "dataset = \"data/home.scene_dataset_config.json\"\nscenes = [" + scenes + "]",
              "count = 6\n" + supports));
    return run({"flat.toml", "--data", sampleFile(""), "--report", "report.json"});
  }

  /// X of all objects and goals of the world's episodes, meters.
  [[nodiscard]] std::vector<float> placesAlongX() const {
    std::vector<float> places;
    const auto world = World::open(std::vector{path("flat.pack")});
    EXPECT_TRUE(world.has_value()) << world.error().text();
    if (!world) return places;
    for (const Episode& episode : world->episodes().episodes()) {
      places.push_back(episode.goal.translation.x);
      for (const Placement& placement : world->episodes().placements(episode)) {
        places.push_back(placement.pose.translation.x);
      }
    }
    return places;
  }

  [[nodiscard]] nlohmann::json generation() const {
    const nlohmann::json all = report();
    for (const auto& entry : all.at("baked")) {
      if (entry.contains("generation")) return entry.at("generation");
    }
    return {};
  }
};

TEST_F(PlanEpisodes, StandInTheReceptaclesOfTheDataset) {
  const ProgramRun west = bakeWorld(R"("c", "well")", R"(supports = "receptacles")");
  ASSERT_EQ(west.exit_code, 0) << west.err;
  EXPECT_THAT(west.out, HasSubstr("scene well is left out: the robot porter stands nowhere"));
  EXPECT_THAT(west.out, HasSubstr("stages/flat.stage_config.json: "
                                  "user_defined.receptacle_aabb_bad.scale: it is missing"));
  EXPECT_THAT(placesAlongX(), AllOf(testing::SizeIs(18), testing::Each(AllOf(Ge(-4.F), Le(-1.F)))));
  const nlohmann::json made = generation();
  ASSERT_EQ(made.at("scenes").size(), 1U);
  EXPECT_EQ(made["scenes"][0]["name"], "c");
  EXPECT_EQ(made["scenes"][0]["receptacles"], 1);
  // The meshes of the dataset are there to settle objects on.
  EXPECT_EQ(made["scenes"][0]["settled"], true);
  ASSERT_EQ(made.at("left_out").size(), 1U);
  EXPECT_EQ(made["left_out"][0]["scene"], "well");
  EXPECT_THAT(made["left_out"][0]["reason"].get<std::string>(), HasSubstr("stands nowhere"));

  // Another annotation: the scene is baked anew for it, and the episodes with it.
  annotate(2.5);
  ASSERT_EQ(bakeWorld(R"("c", "well")", R"(supports = "receptacles")").exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("scenes/c.pack", "episodes.pack"));
  EXPECT_THAT(placesAlongX(), testing::Each(AllOf(Ge(1.F), Le(4.F))));

  // The scenes come from the cache, what is annotated does not.
  ASSERT_EQ(bakeWorld(R"("c", "well")", "").exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("episodes.pack"));
  EXPECT_EQ(generation()["scenes"][0]["receptacles"], 1);
  EXPECT_THAT(placesAlongX(), AllOf(Contains(Ge(1.F)), Contains(testing::Lt(1.F))));
}

TEST_F(PlanEpisodes, AreCountedByADryRunAsByABake) {
  write("flat.toml",
        test::quickRecipe("dataset = \"data/home.scene_dataset_config.json\"\nscenes = [\"c\"]",
                          "count = 6"));
  const std::vector<std::string> words{"flat.toml", "--data", sampleFile(""), "--report",
                                       "report.json"};
  std::vector<std::string> dry = words;
  dry.emplace_back("--dry-run");
  ASSERT_EQ(run(dry).exit_code, 0);
  const std::vector<std::string> planned = packsThatAre("planned");
  EXPECT_THAT(planned, Contains("episodes.pack"));
  ASSERT_EQ(run(words).exit_code, 0);
  EXPECT_EQ(packsThatAre("baked"), planned);
}

TEST_F(PlanEpisodes, GetStartsWhereHabitatsHaveNone) {
  const std::string at = "[[1,0,0,0],[0,1,0,2.2],[0,0,1,0],[0,0,0,1]]";
  write("tidy.json", fmt::format(R"({{"episodes": [{{"scene_id": "c",
      "start_position": [0, 0, 0], "start_rotation": [0, 0, 0, 1],
      "rigid_objs": [["mug", {0}]], "targets": {{"mug_:0000": {0}}}}}]}})",
                                 at));
  std::string recipe =
      test::quickRecipe("dataset = \"data/home.scene_dataset_config.json\"\nscenes = [\"c\"]",
                        "files = \"tidy.json\"");
  const std::string drawing = "objects = 2\n";
  recipe.erase(recipe.find(drawing), drawing.size());
  write("flat.toml", recipe);
  const auto bake = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"flat.toml", "--data", sampleFile(""), "--report",
                                   "report.json"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  ASSERT_EQ(bake({"--dry-run"}).exit_code, 0) << "the packs of the world are not missing";
  const ProgramRun baked = bake({});
  ASSERT_EQ(baked.exit_code, 0) << baked.err;
  EXPECT_THAT(baked.out, testing::Not(HasSubstr("no start")));
  const auto startOf = [&] {
    const auto world = World::open(path("flat.pack"));
    EXPECT_TRUE(world.has_value()) << world.error().text();
    return world ? world->episodes().episodes().front().base_position : Vec3{};
  };
  const Vec3 start = startOf();
  EXPECT_NE(start, (Vec3{}));
  const ProgramRun played =
      runProgram(builtProgram("galactic-run"), path(""), {"flat.pack", "--steps", "2"});
  EXPECT_EQ(played.exit_code, 0) << played.err;
  ASSERT_EQ(bake({}).exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), testing::IsEmpty());
  ASSERT_EQ(bake({"--seed", "5"}).exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("episodes.pack"));
  EXPECT_NE(startOf(), start);
}

TEST_F(PlanEpisodes, SayWhetherTheyCanBeSolved) {
  const auto table =
      AllOf(HasSubstr("episodes.pack:\n"), HasSubstr(": 6 episodes; "),
            HasSubstr("\n  drawn and not taken: "), HasSubstr("\n  the scripted policy solves "));
  const ProgramRun baked = bakeWorld(R"("c")", "");
  ASSERT_EQ(baked.exit_code, 0) << baked.err;
  EXPECT_THAT(baked.out, table);
  EXPECT_THAT(bakeWorld(R"("c")", "").out, AllOf(HasSubstr("\n0 baked, "), table));
}

TEST_F(PlanEpisodes, AreAnErrorWhereNoSceneIsLeft) {
  const ProgramRun none = bakeWorld(R"("well")", "");
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_THAT(none.err, HasSubstr("well: the robot porter stands nowhere"));
  const ProgramRun wrong = bakeWorld(R"("c")", R"(supports = "tables")");
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("supports"));
}

TEST_F(PlanEpisodes, StopBetweenBatchesAndGoOnLater) {
  const std::string recipe = test::quickRecipe(
      "dataset = \"data/home.scene_dataset_config.json\"\nscenes = [\"c\"]", "count = 200");
  write("whole.toml", recipe);
  write("some.toml", recipe);
  const auto words = [&](const std::string& name) {
    return std::vector<std::string>{name, "--data",   sampleFile(""), "-j",
                                    "1",  "--report", "report.json"};
  };
  ASSERT_EQ(run(words("whole.toml")).exit_code, 0);
  const StartedProgram program{builtProgram("galactic-bake"), path(""), words("some.toml")};
  const auto has_drawn = [&] {
    std::error_code none;
    constexpr std::uintmax_t kBatch = 4000;
    const std::uintmax_t size =
        std::filesystem::file_size(path("some/episodes.pack.partial"), none);
    return !none && size > kBatch;
  };
  for (int n = 0; n < 20000 && !has_drawn(); ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  program.signal(SIGINT);
  const ProgramRun stopped = program.wait();
  EXPECT_EQ(stopped.exit_code, kExitInterrupted) << stopped.err;
  EXPECT_THAT(stopped.out, HasSubstr("stopped; the same command goes on from here\n"));
  EXPECT_THAT(stopped.err, testing::Not(HasSubstr("interrupted after")));
  EXPECT_THAT(packsThatAre("planned"), ElementsAre("episodes.pack"));
  EXPECT_FALSE(has("some/episodes.pack"));
  EXPECT_FALSE(has("some.pack"));
  ASSERT_TRUE(has_drawn());
  ASSERT_EQ(run(words("some.toml")).exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("episodes.pack"));
  EXPECT_TRUE(content("some/episodes.pack") == content("whole/episodes.pack"));
  EXPECT_FALSE(has("some/episodes.pack.partial"));
}

}  // namespace
}  // namespace galactic::test::plan_episodes_cli_test
