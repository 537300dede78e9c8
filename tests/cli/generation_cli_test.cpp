// From the sample's sources to a world with generated episodes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/bake_folder.h"
#include "galactic/episode_set.h"
#include "galactic/error.h"
#include "galactic/pack.h"
#include "galactic/world.h"
#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/files/journal.h"

namespace galactic::generation_cli_test {
namespace {

using test::ProgramRun;
using testing::HasSubstr;
using testing::SizeIs;

std::string sample(const char* file) {
  return (test::sourceFolder() / "packs/sample/" / file).string();
}

class GenerationCli : public test::BakeFolder {
 protected:
  /// The sample's packs with few spheres: some seconds.
  void bakePacks() const {
    const std::vector<std::vector<std::string>> commands{
        {sample("apartment.glb"), "--check-columns", "0", "-q"},
        {sample("objects/mug.glb"), sample("objects/book.glb"), "--as", "object", "-o",
         "objects.pack", "--eps", "0.03", "--tau", "0.06", "-q"},
        {sample("robot/porter.urdf"), "--recipe", sample("robot/robot.toml"), "--eps", "0.06",
         "--tau", "0.08", "--max-spheres", "30", "-q"}};
    for (const auto& command : commands) {
      const ProgramRun baked = run(command);
      ASSERT_EQ(baked.exit_code, 0) << baked.err;
    }
  }

  /// Three episodes, unless more is said.
  [[nodiscard]] static std::vector<std::string> drawing(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "apartment.pack", "objects.pack", "porter.pack", "--as", "episodes", "--objects", "2"};
    if (std::ranges::find(more, "--count") == more.end()) {
      arguments.insert(arguments.end(), {"--count", "3"});
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  [[nodiscard]] ProgramRun draw(const std::vector<std::string>& more) const {
    return run(drawing(more));
  }
  /// What a journal holds, as far as it is written.
  [[nodiscard]] std::vector<std::string> recordsOf(const std::string& journal) {
    if (!has(journal)) return {};
    const std::string text = content(journal);
    const std::size_t subject = text.find('\n') + 1;
    // Not the file itself: somebody may be writing it.
    write("copy.partial", text);
    const auto copy = Journal::open(path("copy.partial"),
                                    text.substr(subject, text.find('\n', subject) - subject));
    if (!copy) return {};
    return {(*copy)->records().begin(), (*copy)->records().end()};
  }
  [[nodiscard]] test::StartedProgram startDrawing(const std::vector<std::string>& more) const {
    return {test::builtProgram("galactic-bake"), path(""), drawing(more)};
  }
};

TEST_F(GenerationCli, DoesNotCareAboutTheOrderOfPacksOfOneName) {
  bakePacks();
  write("moved/other.glb", test::fileContent(sample("apartment.glb")));
  std::filesystem::create_directory(path("other"));
  const ProgramRun baked =
      run({"moved/other.glb", "-o", "other/apartment.pack", "--transform",
           "1,0,0,0.5,0,1,0,0,0,0,1,0", "--no-render-meshes", "--check-columns", "0", "-q"});
  ASSERT_EQ(baked.exit_code, 0) << baked.err;
  const auto draw_in = [this](const std::string& first, const std::string& second,
                              const std::string& to) {
    return run({first, second, "objects.pack", "porter.pack", "--as", "episodes", "--count", "2",
                "--objects", "1", "--solve", "0", "-o", to});
  };
  ASSERT_EQ(draw_in("apartment.pack", "other/apartment.pack", "one/set.pack").exit_code, 0);
  ASSERT_EQ(draw_in("other/apartment.pack", "apartment.pack", "two/set.pack").exit_code, 0);
  EXPECT_TRUE(content("one/set.pack") == content("two/set.pack"));
}

TEST_F(GenerationCli, DrawsEpisodesThatMakeAWorldWithTheirPacks) {
  bakePacks();
  const ProgramRun drawn = draw({"--seed", "7"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_THAT(drawn.out, HasSubstr("3 packs -> episodes.pack"));
  EXPECT_THAT(drawn.out, HasSubstr("3 episodes; 1 scene, 2 objects, 6 placements"));
  EXPECT_THAT(drawn.out, HasSubstr("drawn and not taken: "));
  ASSERT_EQ(draw({"--seed", "7", "-o", "again/episodes.pack", "-j", "1"}).exit_code, 0);
  ASSERT_EQ(draw({"--seed", "8", "-o", "other/episodes.pack"}).exit_code, 0);
  EXPECT_TRUE(content("episodes.pack") == content("again/episodes.pack"));
  EXPECT_FALSE(content("episodes.pack") == content("other/episodes.pack"));
  const auto pack = PackFile::open(path("episodes.pack"));
  ASSERT_TRUE(pack.has_value());
  EXPECT_EQ(EpisodeSet::from(*pack)->name(), "episodes") << "it is not of one scene alone";
  // Under another name they are the same episodes.
  ASSERT_EQ(draw({"--seed", "7", "-o", "tidy.pack"}).exit_code, 0);
  EXPECT_FALSE(content("episodes.pack") == content("tidy.pack"));
  EXPECT_EQ(test::runProgram(test::builtProgram("galactic-pack"), path(""),
                             {"diff", "episodes.pack", "tidy.pack", "--content-only"})
                .exit_code,
            0);
  const ProgramRun linked = run({"apartment.pack", "objects.pack", "porter.pack", "episodes.pack",
                                 "--as", "world", "-o", "world.pack"});
  ASSERT_EQ(linked.exit_code, 0) << linked.err;
  const auto world = World::open(std::vector{path("world.pack")});
  ASSERT_TRUE(world.has_value()) << world.error().text();
  EXPECT_EQ(world->episodes().episodes().size(), 3U);
  EXPECT_EQ(world->mostObjects(), 2U);
  const ProgramRun settled =
      draw({"--geometry", "apartment=" + sample("apartment.glb"), "--report", "r.json", "-v"});
  ASSERT_EQ(settled.exit_code, 0) << settled.err;
  EXPECT_THAT(settled.out, HasSubstr("objects settled"));
  const auto report = nlohmann::json::parse(content("r.json"));
  const auto& generation = report["baked"][0]["generation"];
  EXPECT_EQ(generation["scenes"][0]["settled"], true);
  EXPECT_TRUE(generation["rejections"]["tipped"].is_number());
  EXPECT_THAT(settled.out, HasSubstr("the scripted policy solves 3 of 3"));
  EXPECT_EQ(generation["scripted_policy"]["solved"], 3);
  const ProgramRun unplayed = draw({"--solve", "0"});
  EXPECT_THAT(unplayed.out, Not(HasSubstr("scripted policy")));
  const ProgramRun unused = draw({"--split", "validation", "--held-out", "0", "-o", "none.pack"});
  EXPECT_EQ(unused.exit_code, 3);
  EXPECT_THAT(unused.err, HasSubstr("none of the 1 scenes is for validation"));
  const ProgramRun impossible = draw({"--heights", "90,91", "-o", "none.pack"});
  EXPECT_EQ(impossible.exit_code, 3);
  EXPECT_THAT(impossible.err, HasSubstr("no flat surface between 90 and 91 m"));
  EXPECT_FALSE(has("none.pack"));
}

TEST_F(GenerationCli, DrawsTheStartsThatEpisodesOfHabitatLack) {
  bakePacks();
  // Over the floor, where they are in nobody's way.
  const auto at = [](double x) {
    return fmt::format("[[1,0,0,{}],[0,1,0,2.2],[0,0,1,0],[0,0,0,1]]", x);
  };
  const std::string episode = fmt::format(
      R"({{"scene_id": "apartment", "start_position": [0, 0, 0], "start_rotation": [0, 0, 0, 1],
          "rigid_objs": [["mug", {}], ["book", {}]], "targets": {{"mug_:0000": {}}}}})",
      at(0), at(1), at(2));
  write("tidy.json", fmt::format(R"({{"episodes": [{0}, {0}, {0}]}})", episode));
  const std::vector<std::string> packs{"apartment.pack", "objects.pack", "porter.pack"};
  const auto import = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"tidy.json", "--as", "episodes"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  ASSERT_EQ(import({"-o", "bare.pack"}).exit_code, 0);
  const ProgramRun drawn =
      import({"apartment.pack", "porter.pack", "objects.pack", "-o", "drawn.pack"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_THAT(drawn.out, testing::Not(HasSubstr("no start")));
  const auto starts = [&](const std::string& name) {
    std::vector<Vec3> all;
    const auto pack = PackFile::open(path(name));
    EXPECT_TRUE(pack.has_value());
    if (!pack) return all;
    const auto set = EpisodeSet::from(*pack);
    for (const Episode& one : set->episodes()) all.push_back(one.base_position);
    return all;
  };
  EXPECT_THAT(starts("bare.pack"), testing::Each(Vec3{}));
  EXPECT_THAT(starts("drawn.pack"), testing::AllOf(SizeIs(3), testing::Each(testing::Ne(Vec3{}))));
  const auto link = [&](const std::vector<std::string>& more, const std::string& to) {
    std::vector<std::string> words = packs;
    words.insert(words.end(), more.begin(), more.end());
    words.insert(words.end(), {"--as", "world", "-o", to});
    return run(words);
  };
  ASSERT_EQ(link({"drawn.pack"}, "home.pack").exit_code, 0);
  const auto world = World::open(path("home.pack"));
  ASSERT_TRUE(world.has_value()) << world.error().text();
  EXPECT_EQ(world->episodes().robotName(), "porter");

  // Other seeds give other starts, the same packs in a world the same ones.
  ASSERT_EQ(link({}, "parts.pack").exit_code, 0);
  ASSERT_EQ(import({"parts.pack", "--seed", "1", "-o", "same.pack"}).exit_code, 0);
  EXPECT_EQ(starts("same.pack"), starts("drawn.pack"));
  ASSERT_EQ(import({"parts.pack", "--seed", "2", "-o", "other.pack"}).exit_code, 0);
  EXPECT_NE(starts("other.pack"), starts("drawn.pack"));
  // The objects of `object-pack` need not be given again.
  const ProgramRun centered = import(
      {"apartment.pack", "porter.pack", "--object-pack", "objects.pack", "-o", "centered.pack"});
  EXPECT_EQ(centered.exit_code, 0) << centered.err;
  const ProgramRun lacking = import({"apartment.pack", "porter.pack", "-o", "none.pack"});
  EXPECT_EQ(lacking.exit_code, 3);
  EXPECT_THAT(lacking.err, HasSubstr("found 1 scene, 0 objects and 1 robot"));
}

TEST_F(GenerationCli, GoesOnWhereItWasKilled) {
  bakePacks();
  const std::vector<std::string> words{"--count", "400", "--solve", "0", "-j", "1"};
  const auto to = [&](const std::string& pack) {
    std::vector<std::string> all = words;
    all.insert(all.end(), {"-o", pack});
    return all;
  };
  ASSERT_EQ(draw(to("whole/out.pack")).exit_code, 0);
  EXPECT_FALSE(has("whole/out.pack.partial"));
  // Killed after the first of seven batches, and after one more.
  std::size_t kept = 0;
  for (const auto& [wanted, number] : {std::pair{2U, SIGTERM}, std::pair{3U, SIGKILL}}) {
    const test::StartedProgram program = startDrawing(to("out.pack"));
    for (int n = 0; n < 5000 && recordsOf("out.pack.partial").size() < wanted; ++n) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    program.signal(number);
    const ProgramRun ended = program.wait();
    ASSERT_EQ(ended.exit_code, number == SIGKILL ? -1 : kExitInterrupted);
    EXPECT_EQ(ended.err,
              number == SIGKILL
                  ? ""
                  : "\ngalactic-bake: interrupted; the same command goes on where it was\n");
    EXPECT_FALSE(has("out.pack"));
    const std::vector<std::string> records = recordsOf("out.pack.partial");
    EXPECT_GE(records.size(), wanted);
    EXPECT_LT(records.size(), 8U);
    EXPECT_THAT(std::set(records.begin(), records.end()), SizeIs(records.size())) << "done twice";
    kept = records.size();
  }
  // A run that writes nothing changes nothing.
  ASSERT_EQ(draw({"--dry-run", "-o", "out.pack"}).exit_code, 0);
  EXPECT_THAT(recordsOf("out.pack.partial"), SizeIs(kept));
  ASSERT_EQ(draw(to("out.pack")).exit_code, 0);
  EXPECT_TRUE(content("out.pack") == content("whole/out.pack"));
  EXPECT_FALSE(has("out.pack.partial"));
}

TEST_F(GenerationCli, OverwritesNoFileThatItDidNotWrite) {
  bakePacks();
  write("out.pack.partial", "my notes");
  const ProgramRun refused = draw({"-o", "out.pack"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("out.pack.partial: is kept for what is done until"));
  EXPECT_EQ(content("out.pack.partial"), "my notes");
  std::filesystem::copy(path("apartment.pack"), path("to.pack.partial"));
  const ProgramRun read =
      run({"to.pack.partial", "objects.pack", "porter.pack", "--as", "episodes", "-o", "to.pack"});
  EXPECT_NE(read.exit_code, 0);
  EXPECT_TRUE(content("to.pack.partial") == content("apartment.pack"));
}

}  // namespace
}  // namespace galactic::generation_cli_test
