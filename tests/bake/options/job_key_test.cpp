// Keys of the cache: every option of every kind of job is in them, and nothing else.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <set>

#include "bake/options/option_walk.h"

namespace galactic::test::job_key_test {
namespace {

using bake::Job;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const std::vector<Job>& allJobs() {
  static const std::vector<Job> jobs{bake::SceneJob{.input = "room.glb"},
                                     bake::ObjectJob{.inputs = {"mug.glb"}},
                                     bake::RobotJob{.input = "robot.urdf"},
                                     bake::EpisodeImportJob{.input = "home.json"},
                                     bake::EpisodeGenerationJob{.packs = {"home.pack"}},
                                     bake::WorldJob{.packs = {"home.pack"}}};
  return jobs;
}

/// The job with another value of an option; none where it takes no value that we know.
std::optional<Job> changed(const Job& job, const std::string& name) {
  for (const std::string& value : candidateValues()) {
    const auto options = given(name, value);
    Job copy = job;
    bake::OptionReader reader(options);
    visitOptions(copy, reader);
    const bool is_taken = reader.finish("a job", {name}).has_value();
    if (is_taken && contentOptions(copy) != contentOptions(job)) return copy;
  }
  return std::nullopt;
}

TEST(JobKey, ChangesWithEveryOptionOfEveryKind) {
  std::size_t perturbed = 0;
  for (const Job& job : allJobs()) {
    const std::string key = keyOf(job, "/data");
    std::set<std::string> keys{key};
    for (const WalkedOption& option : walk(job)) {
      SCOPED_TRACE(fmt::format("{} of {}", option.name, kindOf(job)));
      const std::optional<Job> other = changed(job, option.name);
      ASSERT_TRUE(other.has_value()) << "candidateValues() lacks a value for it";
      EXPECT_TRUE(keys.insert(keyOf(*other, "/data")).second) << "the key does not change";
      EXPECT_FALSE(*other == job) << "another job";
      ++perturbed;
    }
  }
  EXPECT_GE(perturbed, 70U);
  RecordProperty("options", static_cast<int>(perturbed));
}

TEST(JobKey, ChangesWithInputsNamesAndKinds) {
  std::set<std::string> keys;
  for (const Job& job : allJobs()) EXPECT_TRUE(keys.insert(keyOf(job, "/data")).second);
  EXPECT_TRUE(keys.insert(keyOf(bake::SceneJob{.input = "hall.glb"}, "/data")).second);
  EXPECT_TRUE(
      keys.insert(keyOf(bake::SceneJob{.input = "room.glb", .name = "hall"}, "/data")).second);
  bake::ObjectJob small{.inputs = {"mug.glb"}};
  small.import.smallest_size = 0.1;
  EXPECT_TRUE(keys.insert(keyOf(small, "/data")).second);
  bake::SceneJob instance{.input = "home.json", .instance = bake::InstancedScene{"hall", 1}};
  EXPECT_TRUE(keys.insert(keyOf(instance, "/data")).second);
  instance.instance->dataset_fingerprint = 2;
  EXPECT_TRUE(keys.insert(keyOf(instance, "/data")).second);
}

TEST(Jobs, AreTheSameWhereTheyAskForTheSame) {
  for (const Job& job : allJobs()) {
    EXPECT_TRUE(Job(job) == job) << kindOf(job);
    for (const Job& other : allJobs()) {
      EXPECT_EQ(other == job, kindOf(other) == kindOf(job) && other.index() == job.index());
    }
  }
  const bake::SceneJob hall{.input = "home.json", .instance = bake::InstancedScene{"hall", 1}};
  bake::SceneJob other = hall;
  EXPECT_TRUE(other == hall);
  other.instance->name = "attic";
  EXPECT_FALSE(other == hall);
  bake::EpisodeGenerationJob episodes{.scenes = {{"hall", hall}}};
  EXPECT_FALSE(episodes == bake::EpisodeGenerationJob{});
}

TEST(JobKey, OfRobotsChangesWithTheSearchPathOfPackages) {
  constexpr const char* kVariable = "ROS_PACKAGE_PATH";
  const bake::RobotJob robot{.input = "r.urdf"};
  ::setenv(kVariable, "/opt/ros/share", 1);
  const std::string one = keyOf(robot, "/data");
  ::setenv(kVariable, "/home/me/ros:/opt/ros/share", 1);
  EXPECT_NE(keyOf(robot, "/data"), one);
  EXPECT_EQ(keyOf(bake::SceneJob{}, "/data").find("ros"), std::string::npos);
  ::unsetenv(kVariable);
}

TEST(JobKey, DoesNotDependOnWhereTheDataLie) {
  const bake::RobotJob here{.input = "/here/r.urdf", .recipe = "/here/more/r.toml"};
  const bake::RobotJob there{.input = "/there/r.urdf", .recipe = "/there/more/r.toml"};
  EXPECT_EQ(keyOf(here, "/here"), keyOf(there, "/there"));
  EXPECT_NE(keyOf(here, "/here"), keyOf(there, "/here"));
}

TEST(ContentOptions, AreTheKindAndWhatHasAValueWithoutFolders) {
  bake::RobotJob robot{.input = "/here/r.urdf", .recipe = "/here/more/r.toml"};
  robot.packages = {{"arm", "/opt/ros/arm_description/"}};
  const auto options = contentOptions(robot);
  EXPECT_EQ(options.front(), std::pair(std::string("as"), std::string("robot")));
  EXPECT_THAT(options, Contains(std::pair(std::string("recipe"), std::string("r.toml"))));
  EXPECT_THAT(options,
              Contains(std::pair(std::string("package"), std::string("arm=arm_description"))));
  for (const auto& [name, value] : options) {
    EXPECT_THAT(value, Not(HasSubstr("/")));
    EXPECT_NE(name, "eps") << "it was not given";
  }
  EXPECT_THAT(contentOptions(bake::SceneJob{}).front().first, "radii");
}

TEST(FilesOf, AJobAreItsInputsAndWhatItsOptionsName) {
  const bake::RobotJob robot{
      .input = "r.urdf", .packages = {{"arm", "dir"}}, .recipe = "r.toml", .spheres = "s.urdf"};
  EXPECT_THAT(filesOf(robot), testing::ElementsAre("r.urdf", "r.toml", "s.urdf"));
}

}  // namespace
}  // namespace galactic::test::job_key_test
