#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/packs/scene_pack_builder.h"
#include "support/packs/texture_pack_builder.h"
#include "support/packs/world_pack_builder.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::run_cli_test {
namespace {

using test::ProgramRun;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// A folder with a good pack, one that was cut off, one of a later format, and a file that is no
/// pack.
class RunCli : public testing::Test {
 protected:
  void SetUp() override {
    auto bytes = test::buildPack(test::smallScene());
    const auto text = [&] {
      return std::string(reinterpret_cast<const char*>(bytes.bytes().data()), bytes.size());
    };
    write("good.pack", text());
    write("cut.pack", text().substr(0, 500));
    constexpr std::size_t kVersionOffset = 8;
    bytes.bytes()[kVersionOffset] = std::byte{99};
    write("later.pack", text());
    write("text.pack", std::string(200, 'x'));
  }

  void write(const std::string& name, std::string_view content) {
    ASSERT_EQ(test::fileContent(folder_.write(name, content)), content);
  }
  [[nodiscard]] ProgramRun run(std::vector<std::string> arguments) const {
    return test::runProgram(test::builtProgram("galactic-run"), folder_.path(),
                            std::move(arguments));
  }

  test::ScratchFolder folder_;
};

TEST_F(RunCli, SaysWhatAPackIsAndWhoSaysMore) {
  const ProgramRun result = run({"good.pack"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(StartsWith("good.pack: scene "), HasSubstr("verified in"),
                                HasSubstr("\ngalactic-pack info FILE says what is in a pack.\n")));
  EXPECT_THAT(result.err, IsEmpty());
}

TEST_F(RunCli, SaysWhatToDoWithoutAPack) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{}, {"--steps", "7"}, {"--quiet"}}) {
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err,
              "galactic-run: command line: found no pack; name one to open and verify it "
              "(galactic-run world.pack), or a world to step (galactic-run world.pack --steps "
              "1000); galactic-bake makes packs; see --help\n");
  }
}

TEST_F(RunCli, NamesTheNearestOptionWhereThePackWasForgottenToo) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--hlep"}, {"--bench", "--hlep"}, {"good.pack", "--hlep"}}) {
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, AllOf(StartsWith("galactic-run: command line: "), HasSubstr("--hlep"),
                                  HasSubstr("did you mean '--help'")));
  }
}

TEST_F(RunCli, KeepsItsExitCodeWhereNobodyHearsItsErrors) {
  for (const char* unheard : {"2>&-", "2>/dev/full"}) {
    const auto exit_code = [&](const char* argument) {
      return test::runRedirected(test::builtProgram("galactic-run"), folder_.path(), {argument},
                                 unheard)
          .exit_code;
    };
    EXPECT_EQ(exit_code("text.pack"), 3) << unheard;
    EXPECT_EQ(exit_code("--nonsense"), 1) << unheard;
  }
}

TEST_F(RunCli, SaysHowManyEpisodesAndPacksThereAre) {
  write("tidy.pack", test::textOf(test::buildPack(test::smallEpisodes())));
  write("world.pack", test::textOf(test::buildPack(test::smallWorldPack())));
  const ProgramRun result = run({"tidy.pack", "world.pack"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(StartsWith("tidy.pack: 2 episodes \"tidy\", format 1"),
                                HasSubstr("\nworld.pack: world of 4 packs, format 1"),
                                HasSubstr("\n  the packs that it lists are not opened; "
                                          "galactic-pack check opens them, too\n")));
}

TEST_F(RunCli, SkipsVerificationOnlyWhenTold) {
  const ProgramRun result = run({"good.pack", "--trusted"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, Not(HasSubstr("verified in")));
}

TEST_F(RunCli, PrintsErrorsOnlyWhenToldToBeQuiet) {
  const ProgramRun good = run({"good.pack", "--quiet"});
  EXPECT_EQ(good.exit_code, 0);
  EXPECT_THAT(good.out, IsEmpty());
  const ProgramRun bad = run({"cut.pack", "-q"});
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_THAT(bad.err, StartsWith("galactic-run: cut.pack: "));
}

TEST_F(RunCli, MeasuresQueries) {
  const ProgramRun result = run({"good.pack", "--bench"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("coherent, 128 robots"), HasSubstr("random")));
}

TEST_F(RunCli, MeasuresNothingWhereNothingIsPrinted) {
  const ProgramRun result = run({"good.pack", "--bench", "-q"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, HasSubstr("--quiet leaves out the table"));
}

TEST_F(RunCli, SummarizesATexture) {
  write("wood.pack", test::textOf(test::buildPack(test::TexturePackFields{})));
  const ProgramRun result = run({"wood.pack"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("wood.pack: texture \"oak\", format 1"));
}

TEST_F(RunCli, EndsWithACodeForEachKindOfMistake) {
  const std::vector<std::pair<std::vector<std::string>, int>> mistakes{
      {{}, 1},           {{"--pack"}, 1},    {{"--no-such-option"}, 1}, {{"missing.pack"}, 2},
      {{"cut.pack"}, 3}, {{"text.pack"}, 3}, {{"later.pack"}, 5},
  };
  for (const auto& [arguments, code] : mistakes) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.exit_code, code);
    EXPECT_THAT(result.err, Not(IsEmpty()));
    if (code > 1) {
      EXPECT_THAT(result.err, StartsWith("galactic-run: " + arguments.back() + ": "));
    }
  }
}

TEST_F(RunCli, ListsItsExitCodesInHelp) {
  const ProgramRun help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, AllOf(HasSubstr("PACK FILE ..."), HasSubstr("--bench"),
                              HasSubstr("0    success"), HasSubstr("3    invalid input")));
  // One of two ways to name packs is needed, not both.
  EXPECT_THAT(help.out, AllOf(HasSubstr("\n  PACK FILE ... REQUIRED          Packs to open"),
                              HasSubstr("\n  --pack FILE ...                 The same as PACK\n"),
                              Not(HasSubstr("--pack FILE ... REQUIRED"))));
}

TEST_F(RunCli, KeepsOptionsAndTheirExplanationsApartInHelp) {
  // These options fill their column but for one blank.
  const std::string help = run({"--help"}).out;
  for (const char* option :
       {"--camera-position X,Y,Z [0,0,0]", "--success-distance METERS [0.1]"}) {
    EXPECT_THAT(help, HasSubstr("\n  " + std::string(option) + "\n" + std::string(34, ' ')));
  }
}

}  // namespace
}  // namespace galactic::run_cli_test
