// galactic-bake --check as a user meets it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "cli/bake_folder.h"
#include "galactic/error.h"
#include "support/episode_set_text.h"

namespace galactic::report_check_cli_test {
namespace {

using nlohmann::json;
using test::ProgramRun;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

/// A folder with a set of episodes, the quickest of all bakes, and the report of its bake.
class ReportCheck : public test::BakeFolder {
 protected:
  void SetUp() override {
    write("tidy.episode_set.json", test::kSmallEpisodeSet);
    ASSERT_EQ(bake({"--report", "golden.json"}).exit_code, 0);
  }

  [[nodiscard]] ProgramRun bake(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"tidy.episode_set.json", "--start-joints", "pan,lift"});
    return run(std::move(arguments));
  }

  /// Bakes again after a change of the golden report.
  ProgramRun after(const std::function<void(json&)>& change,
                   std::vector<std::string> arguments = {}) {
    json golden = json::parse(content("golden.json"));
    change(golden);
    write("changed.json", golden.dump());
    arguments.insert(arguments.end(), {"--check", "changed.json", "-q"});
    return bake(std::move(arguments));
  }

  /// The only line for a change.
  void expectDifference(const std::function<void(json&)>& change, const std::string& line) {
    SCOPED_TRACE(line);
    const ProgramRun run = after(change);
    EXPECT_EQ(run.exit_code, kExitDiffers);
    EXPECT_THAT(run.out, HasSubstr("changed.json: " + line + "\n"));
    EXPECT_THAT(run.out, HasSubstr("changed.json: 1 differences in "));
    EXPECT_THAT(run.err, IsEmpty());
  }
};

TEST_F(ReportCheck, AgreesWithTheReportOfTheSameBake) {
  const ProgramRun same = bake({"--check", "golden.json"});
  EXPECT_EQ(same.exit_code, 0) << same.out;
  EXPECT_THAT(same.out, HasSubstr("golden.json: as expected in "));
  const ProgramRun quiet = bake({"--check", "golden.json", "-q"});
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_THAT(quiet.out, IsEmpty());
}

TEST_F(ReportCheck, TellsEachDifference) {
  expectDifference([](json& g) { g["baked"][0]["episodes"] = 3; },
                   "baked[0].episodes: 2, expected 3");
  expectDifference([](json& g) { g["baked"][0]["name"] = "other"; },
                   "baked[0].name: \"tidy\", expected \"other\"");
  expectDifference([](json& g) { g["baked"][0]["scenes"][1] = "attic"; },
                   "baked[0].scenes[1]: \"b_room\", expected \"attic\"");
  expectDifference([](json& g) { g["baked"][0]["scenes"].push_back("attic"); },
                   "baked[0].scenes: 2 elements, expected 3");
  expectDifference([](json& g) { g["baked"][0].erase("robot"); },
                   "baked[0].robot: \"\", expected nothing");
  expectDifference([](json& g) { g["baked"][0]["color"] = 1; },
                   "baked[0].color: nothing, expected 1");
  expectDifference([](json& g) { g["baked"][0]["pack_bytes"] = "many"; },
                   "baked[0].pack_bytes: " +
                       json::parse(content("golden.json"))["baked"][0]["pack_bytes"].dump() +
                       ", expected \"many\"");
  expectDifference(
      [](json& g) {
        g["failed"].push_back({{"code", 3}});
      },
      "failed: 0 elements, expected 1");
}

TEST_F(ReportCheck, IgnoresTimesPathsAndVersion) {
  const ProgramRun run = after([](json& g) {
    g["version"] = "0.0.1";
    g["baked"][0]["seconds"] = 1e6;
    g["baked"][0]["input"] = "/elsewhere/x";
    g["baked"][0].erase("output");
  });
  EXPECT_EQ(run.exit_code, 0) << run.out;
}

TEST_F(ReportCheck, TakesNumbersWithAFractionForTheSameWhenTheyNearlyAre) {
  const auto scaled = [](double factor) {
    return [factor](json& g) {
      json& mean = g["baked"][0]["target_to_goal"]["mean"];
      mean = mean.get<double>() * factor;
    };
  };
  EXPECT_EQ(after(scaled(1 + 1e-7)).exit_code, 0);
  EXPECT_EQ(after(scaled(1 + 1e-5)).exit_code, kExitDiffers);
  EXPECT_EQ(after(scaled(1.04), {"--check-tolerance", "0.05"}).exit_code, 0);
  EXPECT_EQ(after(scaled(1.06), {"--check-tolerance", "0.05"}).exit_code, kExitDiffers);
}

TEST_F(ReportCheck, HeedsTheTolerancesOfTheGoldenReport) {
  const auto with = [this](const json& tolerances) {
    return after([&tolerances](json& g) {
             g["baked"][0]["episodes"] = 3;
             g["tolerances"] = tolerances;
           })
        .exit_code;
  };
  EXPECT_EQ(with({{"episodes", 0.5}}), 0);
  EXPECT_EQ(with({{"episodes", 0.1}}), kExitDiffers);
  EXPECT_EQ(with({{"episodes", nullptr}}), 0);
  EXPECT_EQ(with({{"baked.episodes", 0.5}, {"episodes", 0}}), 0) << "the longest end counts";
  EXPECT_EQ(with({{"pisodes", 0.5}}), kExitDiffers) << "whole keys only";
  EXPECT_EQ(with({{"baked", nullptr}}), 0) << "with all that is in it";
  EXPECT_EQ(with({{"baked", 0.5}}), 0);
  EXPECT_EQ(with({{"baked", 0.5}, {"episodes", 0.1}}), kExitDiffers) << "the nearer one counts";
}

TEST_F(ReportCheck, TakesErrorsForUpperBounds) {
  // A scene's report has errors; a set of episodes gets the key by hand.
  json golden = json::parse(content("golden.json"));
  json& distances = golden["baked"][0]["target_to_goal"];
  const double max = distances["max"];
  // The report has no key of a bound: the rule is seen on a scene below.
  EXPECT_GT(max, 0);
  write("room.obj",
        "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nv 1 1 0\nv 1 1 1\nv 0 1 1\n"
        "f 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\n");
  const std::vector<std::string> room{"room.obj",        "--radii", "0.1",
                                      "--spacing",       "0.1",     "--no-render-meshes",
                                      "--check-columns", "8",       "-q"};
  const auto run_with = [this, &room](const char* option, const char* file) {
    std::vector<std::string> arguments = room;
    arguments.insert(arguments.end(), {option, file});
    return run(arguments);
  };
  ASSERT_EQ(run_with("--report", "room.json").exit_code, 0);
  json report = json::parse(content("room.json"));
  json& errors = report["baked"][0]["grids"][0]["cast_check"]["errors"];
  const double found = errors;
  errors = found + 1;
  write("more.json", report.dump());
  EXPECT_EQ(run_with("--check", "more.json").exit_code, 0) << "fewer errors are welcome";
  errors = found - 1;
  write("fewer.json", report.dump());
  const ProgramRun worse = run_with("--check", "fewer.json");
  EXPECT_EQ(worse.exit_code, kExitDiffers);
  EXPECT_THAT(worse.out, HasSubstr("cast_check.errors: "));
  EXPECT_THAT(worse.out, HasSubstr("expected at most "));
}

TEST_F(ReportCheck, KeepsTheExitCodeOfABakeThatFails) {
  write("broken.episode_set.json", "{}");
  const ProgramRun run = bake(
      {"broken.episode_set.json", "--keep-going", "-o", "packs", "--check", "golden.json", "-q"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.out, HasSubstr("failed: 1 elements, expected 0"));
}

TEST_F(ReportCheck, ExplainsEveryRefusal) {
  write("text.json", "no JSON");
  write("other.json", "{\"tool\": \"galactic-run\"}");
  json golden = json::parse(content("golden.json"));
  golden["tolerances"] = {{"episodes", -1}};
  write("negative.json", golden.dump());
  golden["tolerances"] = 3;
  write("number.json", golden.dump());
  const std::vector<test::Refusal> refusals{
      {{"--check", "none.json"}, 2, "none.json: cannot "},
      {{"--check", "text.json"}, 3, "text.json: is not a report of galactic-bake"},
      {{"--check", "other.json"}, 3, "other.json: is not a report of galactic-bake"},
      {{"--check", "negative.json"},
       3,
       "negative.json: tolerances.episodes: is neither a share of 0 or more"},
      {{"--check", "number.json"}, 3, "number.json: tolerances: expected an object"},
      {{"--check", "golden.json", "--report", "golden.json"}, 3, "is also an input"},
      {{"--check", "golden.json", "--check-tolerance", "-1"}, 1, "--check-tolerance"},
  };
  std::filesystem::remove(path("tidy.pack"));
  for (const test::Refusal& refusal : refusals) {
    SCOPED_TRACE(testing::PrintToString(refusal.arguments));
    const ProgramRun run = bake(refusal.arguments);
    EXPECT_EQ(run.exit_code, refusal.exit_code);
    EXPECT_THAT(run.err, HasSubstr(refusal.part));
    EXPECT_FALSE(has("tidy.pack")) << "nothing is baked";
  }
}

}  // namespace
}  // namespace galactic::report_check_cli_test
