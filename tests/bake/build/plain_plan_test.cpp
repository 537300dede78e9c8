// What is planned for a dataset are values: whoever builds it, and on how many threads, makes the
// same packs.
#include <gtest/gtest.h>

#include <string>

#include "bake/dataset/small_dataset.h"
#include "galactic/bake/build.h"
#include "galactic/bake/job_lists.h"
#include "support/file_content.h"

namespace galactic::test::plain_plan_test {
namespace {

class APlan : public testing::Test {
 protected:
  APlan() {
    for (const char* name : {"one", "two"}) {
      small_.writeScene(name, R"({"stage_instance": {"template_name": "room"}})");
    }
  }

  [[nodiscard]] bake::WorldPlan planned(bake::BakeLibraries& libraries) const {
    bake::DatasetJobs dataset{.input = small_.config(), .scenes = {"one", "two"}};
    dataset.scene.grids.radii = {0.2F};
    dataset.scene.grids.spacing = 0.2F;
    auto plan =
        bake::jobsOfDatasets({dataset}, small_.scratch().path() / "out/home.pack", libraries);
    EXPECT_TRUE(plan) << plan.error().text();
    return plan ? std::move(*plan) : bake::WorldPlan{};
  }
  /// Both scenes' packs.
  [[nodiscard]] static std::string built(const bake::WorldPlan& plan, unsigned threads,
                                         bake::BakeLibraries& libraries) {
    bake::BuildObserver observer;
    const auto outcome = bake::build(plan, {.threads = threads}, observer, libraries);
    EXPECT_EQ(outcome.firstError(), nullptr) << outcome.firstError()->text();
    std::string packs;
    for (const bake::PackJob& pack : plan.assets) packs += fileContent(pack.output);
    return packs;
  }

  SmallDataset small_;
};

TEST_F(APlan, IsTheSameHoweverOftenItIsMade) {
  bake::BakeLibraries libraries;
  const bake::WorldPlan first = planned(libraries);
  const bake::WorldPlan again = planned(libraries);
  bake::BakeLibraries others;
  const bake::WorldPlan other = planned(others);
  ASSERT_EQ(first.assets.size(), 2U);
  for (std::size_t n = 0; n < first.assets.size(); ++n) {
    EXPECT_TRUE(first.assets[n].job == again.assets[n].job) << first.assets[n].name;
    EXPECT_TRUE(first.assets[n].job == other.assets[n].job) << first.assets[n].name;
  }
  EXPECT_FALSE(first.assets[0].job == first.assets[1].job);
}

TEST_F(APlan, IsBuiltWithTheLibrariesOfItsPlannerOrWithOthers) {
  bake::BakeLibraries libraries;
  const bake::WorldPlan plan = planned(libraries);
  const std::string packs = built(plan, 1, libraries);
  EXPECT_GT(packs.size(), 1000U);
  bake::BakeLibraries others;
  EXPECT_TRUE(built(plan, 2, others) == packs);
}

}  // namespace
}  // namespace galactic::test::plain_plan_test
