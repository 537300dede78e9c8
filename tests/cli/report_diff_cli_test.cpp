// Reports of galactic-bake, and galactic-pack diff between them, as a CI job meets both.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "cli/bake_folder.h"
#include "galactic/error.h"
#include "support/build_paths.h"
#include "support/episode_set_text.h"

namespace galactic::report_diff_cli_test {
namespace {

using nlohmann::json;
using test::ProgramRun;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A folder with the report of a set of episodes, the quickest of all bakes.
class ReportDiff : public test::BakeFolder {
 protected:
  void SetUp() override {
    write("tidy.episode_set.json", test::kSmallEpisodeSet);
    const ProgramRun baked =
        run({"tidy.episode_set.json", "--start-joints", "pan,lift", "--report", "report.json"});
    ASSERT_EQ(baked.exit_code, 0) << baked.err;
  }

  [[nodiscard]] ProgramRun diff(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "diff");
    return test::runProgram(test::builtProgram("galactic-pack"), path(""), std::move(arguments));
  }

  /// Compares the report with a golden one that is it after a change.
  ProgramRun after(const std::function<void(json&)>& change,
                   std::vector<std::string> options = {}) {
    json golden = json::parse(content("report.json"));
    change(golden);
    write("golden.json", golden.dump());
    options.insert(options.begin(), {"golden.json", "report.json"});
    return diff(options);
  }

  /// The only difference after a change.
  void expectDifference(const std::function<void(json&)>& change, const std::string& line) {
    SCOPED_TRACE(line);
    const ProgramRun run = after(change);
    EXPECT_EQ(run.exit_code, kExitDiffers);
    EXPECT_EQ(run.out, "A golden.json\nB report.json\ndiffer\ncontent (A | B)\n  " + line + "\n");
    EXPECT_THAT(run.err, IsEmpty());
  }
};

TEST_F(ReportDiff, CallsAReportIdenticalToItself) {
  const ProgramRun same = diff({"report.json", "report.json"});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_EQ(same.out, "A report.json\nB report.json\nidentical\n");
}

TEST_F(ReportDiff, TellsEachDifference) {
  expectDifference([](json& g) { g["baked"][0]["episodes"] = 3; }, "baked.tidy.episodes: 3 | 2");
  expectDifference([](json& g) { g["baked"][0]["scenes"][1] = "attic"; },
                   "baked.tidy.scenes.1: attic | b_room");
  expectDifference([](json& g) { g["baked"][0]["scenes"].push_back("attic"); },
                   "baked.tidy.scenes.2: attic | none");
  expectDifference([](json& g) { g["baked"][0].erase("robot"); }, "baked.tidy.robot: none | ");
  expectDifference([](json& g) { g["baked"][0]["color"] = 1; }, "baked.tidy.color: 1 | none");
  expectDifference([](json& g) { g["baked"][0]["pack_bytes"] = "many"; },
                   "baked.tidy.pack_bytes: many | " +
                       json::parse(content("report.json"))["baked"][0]["pack_bytes"].dump());
  expectDifference(
      [](json& g) {
        g["failed"].push_back({{"code", 3}});
      },
      "failed.0.code: 3 | none");
}

TEST_F(ReportDiff, PairsPacksByTheirNames) {
  const ProgramRun run = after([](json& g) {
    json other = g["baked"][0];
    other["name"] = "another";
    g["baked"].insert(g["baked"].begin(), other);
  });
  EXPECT_EQ(run.exit_code, kExitDiffers);
  EXPECT_THAT(run.out, AllOf(HasSubstr("baked.another.episodes: 2 | none\n"),
                             Not(HasSubstr("baked.tidy."))));
}

TEST_F(ReportDiff, PrintsTheSameAsJson) {
  const ProgramRun run = after([](json& g) { g["baked"][0]["episodes"] = 3; }, {"--json"});
  const json found = json::parse(run.out);
  EXPECT_EQ(found.at("differs"), true);
  EXPECT_THAT(found.at("content"),
              ElementsAre(json{{"field", "baked.tidy.episodes"}, {"a", "3"}, {"b", "2"}}));
}

TEST_F(ReportDiff, IgnoresTimesPathsAndVersion) {
  const ProgramRun run = after([](json& g) {
    g["version"] = "0.0.1";
    g["run"] = {{"unchanged", 3}};
    g["baked"][0]["seconds"] = 1e6;
    g["baked"][0]["input"] = "/elsewhere/x";
    g["baked"][0].erase("output");
  });
  EXPECT_EQ(run.exit_code, 0) << run.out;
  EXPECT_THAT(run.out, HasSubstr("\nequal\n"));
}

TEST_F(ReportDiff, TakesNumbersWithAFractionForTheSameWhenTheyNearlyAre) {
  const auto scaled = [](double factor) {
    return [factor](json& g) {
      json& mean = g["baked"][0]["target_to_goal"]["mean"];
      mean = mean.get<double>() * factor;
    };
  };
  EXPECT_EQ(after(scaled(1 + 1e-7)).exit_code, 0);
  EXPECT_EQ(after(scaled(1 + 1e-5)).exit_code, kExitDiffers);
  EXPECT_EQ(after(scaled(1.04), {"--share", "0.05"}).exit_code, 0);
  const ProgramRun more = after(scaled(1.06), {"--share", "0.05"});
  EXPECT_EQ(more.exit_code, kExitDiffers);
  EXPECT_THAT(more.out, HasSubstr(" within 5 % | "));
}

TEST_F(ReportDiff, HeedsTheTolerancesOfTheGoldenReport) {
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

TEST_F(ReportDiff, TakesErrorsForUpperBounds) {
  write("room.obj",
        "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nv 1 1 0\nv 1 1 1\nv 0 1 1\n"
        "f 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\n");
  ASSERT_EQ(run({"room.obj", "--radii", "0.1", "--spacing", "0.1", "--no-render-meshes",
                 "--check-columns", "8", "-q", "--report", "report.json"})
                .exit_code,
            0);
  const auto with = [this](double more) {
    return after([more](json& g) {
      json& errors = g["baked"][0]["grids"][0]["cast_check"]["errors"];
      errors = errors.get<double>() + more;
    });
  };
  EXPECT_EQ(with(1).exit_code, 0) << "fewer errors are welcome";
  const ProgramRun worse = with(-1);
  EXPECT_EQ(worse.exit_code, kExitDiffers);
  EXPECT_THAT(worse.out, HasSubstr("cast_check.errors: at most "));
}

TEST_F(ReportDiff, TellsABakeThatFailedFromOneThatDidNot) {
  write("broken.episode_set.json", "{}");
  const ProgramRun failed =
      run({"tidy.episode_set.json", "broken.episode_set.json", "--start-joints", "pan,lift",
           "--keep-going", "-o", "packs", "-q", "--report", "failed.json"});
  EXPECT_EQ(failed.exit_code, 3);
  const ProgramRun compared = diff({"report.json", "failed.json"});
  EXPECT_EQ(compared.exit_code, kExitDiffers);
  EXPECT_THAT(compared.out, HasSubstr("failed.0.code: none | "));
}

TEST_F(ReportDiff, ExplainsEveryRefusal) {
  write("text.json", "no JSON");
  write("deep.json", std::string(100000, '[') + std::string(100000, ']'));
  write("other.json", "{\"tool\": \"galactic-run\"}");
  json golden = json::parse(content("report.json"));
  golden["tolerances"] = {{"episodes", -1}};
  write("negative.json", golden.dump());
  golden["tolerances"] = 3;
  write("number.json", golden.dump());
  const std::vector<test::Refusal> refusals{
      {{"none.json", "report.json"}, 2, "none.json: cannot "},
      {{"text.json", "report.json"}, 3, "text.json: is not a report of galactic-bake"},
      {{"deep.json", "report.json"}, 3, "deep.json: is not a report of galactic-bake"},
      {{"report.json", "other.json"}, 3, "other.json: is not a report of galactic-bake"},
      {{"negative.json", "report.json"},
       3,
       "negative.json: tolerances.episodes: is neither a share of 0 or more"},
      {{"number.json", "report.json"}, 3, "number.json: tolerances: expected an object"},
      {{"report.json", "report.json", "--share", "-1"}, 1, "--share"},
      {{"report.json", "report.json", "--tolerance", "1"}, 1, "--tolerance: is about packs"},
      {{"report.json", "report.json", "--content-only"}, 1, "--content-only: is about packs"},
      {{"tidy.pack", "tidy.pack", "--share", "1"}, 1, "--share: is about reports"},
      {{"report.json", "tidy.pack"}, 1, "found the report report.json and the pack tidy.pack"},
  };
  for (const test::Refusal& refusal : refusals) {
    SCOPED_TRACE(testing::PrintToString(refusal.arguments));
    const ProgramRun run = diff(refusal.arguments);
    EXPECT_EQ(run.exit_code, refusal.exit_code);
    EXPECT_THAT(run.err, HasSubstr(refusal.part));
    EXPECT_THAT(run.out, IsEmpty());
  }
}

}  // namespace
}  // namespace galactic::report_diff_cli_test
