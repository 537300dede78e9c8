// Recordings that galactic-run plays again, as a user meets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "cli/simulation_folder.h"
#include "run/recording.h"

namespace galactic::replay_cli_test {
namespace {

using nlohmann::json;
using test::ProgramRun;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

using ReplayCli = test::SimulationFolder;

TEST_F(ReplayCli, ReplaysARecordingBitForBit) {
  record();
  for (const char* threads : {"1", "2"}) {
    const ProgramRun result = run({"--policy", "replay:run.rec", "--threads", threads});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, AllOf(StartsWith("5 envs, 40 steps each, "),
                                  HasSubstr("replay        40 steps, bit for bit the same\n")));
  }
  // Options that say the same are fine, and so are fewer steps and a copy.
  const ProgramRun copy = run({"--policy", "replay:run.rec", "--seed", "9", "--safe-drop",
                               "--record", "copy.rec", "--report", "report.json"});
  EXPECT_EQ(copy.exit_code, 0) << copy.err;
  EXPECT_EQ(content("copy.rec"), content("run.rec"));
  EXPECT_TRUE(json::parse(content("report.json"))["first_difference"].is_null());
  const ProgramRun fewer = run({"--policy", "replay:run.rec", "--steps", "7"});
  EXPECT_EQ(fewer.exit_code, 0) << fewer.err;
  EXPECT_THAT(fewer.out, HasSubstr("7 steps, bit for bit the same"));
}

TEST_F(ReplayCli, ReplaysTheNoiseOfARecording) {
  const std::vector<std::string> noise{"--motion-noise",       "0.2", "--motion-bias",  "0.1",
                                       "--localization-noise", "0.1", "--action-delay", "2"};
  const std::vector<std::string> plain{"--envs", "5", "--steps", "60", "--seed", "9"};
  std::vector<std::string> noisy = plain;
  noisy.insert(noisy.end(), noise.begin(), noise.end());
  const json report = reportOf(noisy);
  EXPECT_EQ(report["options"]["motion-noise"], 0.2);
  EXPECT_EQ(report["options"]["action-delay"], 2);
  EXPECT_NE(report["reward"], reportOf(plain)["reward"]);
  noisy.insert(noisy.end(), {"--record", "noisy.rec"});
  ASSERT_EQ(run(noisy).exit_code, 0);
  for (const char* threads : {"1", "2"}) {
    const ProgramRun replay = run({"--policy", "replay:noisy.rec", "--threads", threads});
    EXPECT_EQ(replay.exit_code, 0) << replay.err;
    EXPECT_THAT(replay.out, HasSubstr("replay        60 steps, bit for bit the same\n"));
  }
  // It has the actions that were asked for: those of the same policy without noise.
  std::vector<std::string> exact = plain;
  exact.insert(exact.end(), {"--record", "exact.rec"});
  ASSERT_EQ(run(exact).exit_code, 0);
  const auto first_actions = [&](const char* name) {
    Result<RecordingReader> reader = RecordingReader::open(folder_.path() / name);
    std::vector<float> actions(reader->subject().actionCount());
    EXPECT_TRUE(reader->next(actions));
    return actions;
  };
  EXPECT_EQ(first_actions("noisy.rec"), first_actions("exact.rec"));
  const ProgramRun other = run({"--policy", "replay:noisy.rec", "--motion-noise", "0.3"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_THAT(other.err, HasSubstr("was recorded with motion-noise 0.2"));
}

TEST_F(ReplayCli, ReplaysTheNoiseThatEpisodesHaveDrawn) {
  const std::vector<std::string> plain{"--envs", "5", "--steps", "60", "--seed", "9"};
  std::vector<std::string> drawn = plain;
  drawn.insert(drawn.end(), {"--motion-noise", "0.1-0.6", "--action-delay", "0-3", "--laser-beams",
                             "8", "--laser-noise", "0.01-0.05", "--record", "drawn.rec"});
  const json report = reportOf(drawn);
  EXPECT_EQ(report["options"]["motion-noise"], "0.1-0.6");
  EXPECT_EQ(report["options"]["action-delay"], "0-3");
  EXPECT_EQ(report["options"]["laser-noise"], "0.01-0.05");
  EXPECT_NE(report["reward"], reportOf(plain)["reward"]);
  for (const char* threads : {"1", "2"}) {
    const ProgramRun replay = run({"--policy", "replay:drawn.rec", "--threads", threads});
    EXPECT_EQ(replay.exit_code, 0) << replay.err;
    EXPECT_THAT(replay.out, HasSubstr("replay        60 steps, bit for bit the same\n"));
  }
  const ProgramRun other = run({"--policy", "replay:drawn.rec", "--motion-noise", "0.1-0.5"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_THAT(other.err, HasSubstr("was recorded with motion-noise 0.1-0.6"));
}

TEST_F(ReplayCli, RefusesAReplayOfSomethingElse) {
  record();
  const auto refused = [&](std::vector<std::string> arguments, const std::string& message) {
    arguments.insert(arguments.end(), {"--policy", "replay:run.rec"});
    const ProgramRun result = run(std::move(arguments));
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.err, AllOf(StartsWith("galactic-run: run.rec: "), HasSubstr(message)));
  };
  refused({"--seed", "8"}, "was recorded with seed 9");
  refused({"--slide", "off"}, "was recorded with slide-attempts 3");
  refused({"--task", "pick"}, "was recorded with task rearrange");
  refused({"--steps", "41"}, "holds 40 steps, and --steps asks for 41");
  test::WorldFields other = test::smallHomeWorld();
  other.episodes.episodes[0].base_yaw += 0.01F;
  writeWorld(other);
  refused({},
          "was recorded with another world: 4 packs then, 4 now, and one of kind EPIS is another");
}

TEST_F(ReplayCli, EndsWithSevenWhereAReplayDiffers) {
  record();
  // The same steps, but for the digest of one of them.
  Result<RecordingReader> reader = RecordingReader::open(folder_.path() / "run.rec");
  ASSERT_TRUE(reader);
  Result<RecordingWriter> writer =
      RecordingWriter::create(folder_.path() / "other.rec", reader->subject());
  ASSERT_TRUE(writer);
  std::vector<float> actions(reader->subject().actionCount());
  for (std::uint64_t step = 0; step < reader->steps(); ++step) {
    const Result<std::uint64_t> digest = reader->next(actions);
    ASSERT_TRUE(digest);
    ASSERT_TRUE(writer->append(actions, *digest ^ (step >= 23 ? 1U : 0U)));
  }
  ASSERT_TRUE(writer->finish());
  const ProgramRun result =
      run({"--policy", "replay:other.rec", "--report", "report.json", "--envs", "5"});
  EXPECT_EQ(result.exit_code, 7);
  EXPECT_THAT(result.err,
              StartsWith("galactic-run: other.rec: step 23 differs from the recording"));
  EXPECT_THAT(result.out, HasSubstr("replay        differs at step 23\n"));
  EXPECT_EQ(json::parse(content("report.json"))["first_difference"], 23);
}

TEST_F(ReplayCli, RefusesADamagedRecording) {
  record();
  const std::string whole = content("run.rec");
  const std::vector<std::pair<std::string, std::string>> damages{
      {"", "is not a recording"},
      {"x" + whole, "is not a recording"},
      {whole.substr(0, whole.size() - 1), "has "},
      {whole.substr(0, 100), "has 100 bytes"},
  };
  for (const auto& [bytes, message] : damages) {
    static_cast<void>(folder_.write("cut.rec", bytes));
    const ProgramRun result = run({"--policy", "replay:cut.rec"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.err, AllOf(StartsWith("galactic-run: cut.rec: "), HasSubstr(message)));
  }
  // Found only when its step comes: the run ends there, and no copy of it is left.
  std::string flipped = whole;
  flipped[flipped.size() - 20] = static_cast<char>(flipped[flipped.size() - 20] ^ 1);
  static_cast<void>(folder_.write("cut.rec", flipped));
  const ProgramRun result = run({"--policy", "replay:cut.rec", "--record", "copy.rec"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("damaged at step 39"));
  EXPECT_THAT(files(), Not(testing::Contains(StartsWith("copy.rec"))));
}

}  // namespace
}  // namespace galactic::replay_cli_test
