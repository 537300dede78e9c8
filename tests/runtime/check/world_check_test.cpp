// One wrong value per field of a world pack whose hash is right: each has its own message.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "galactic/pack.h"
#include "galactic/pack_reference.h"
#include "runtime/check/pack_damage.h"
#include "runtime/check/pack_offence.h"
#include "support/packs/world_pack_builder.h"

namespace galactic::test::world_check_test {
namespace {

using Fields = WorldPackFields;
using Offence = PackOffence<Fields>;

void refuse(const std::vector<Offence>& offences) { expectRefused(smallWorldPack(), offences); }

/// An offence of the path of the first pack.
Offence path(const std::string& path, const std::string& message) {
  return {"world.packs[0].path", message, [path](Fields& f) { f.packs[0].path = path; }};
}

TEST(WorldCheck, AcceptsTheWorldThatTheOffencesBelowStartFrom) {
  const AlignedBytes bytes = buildPack(smallWorldPack());
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().text();
}

TEST(WorldCheck, AcceptsDotsInsideNames) {
  Fields fields = smallWorldPack();
  fields.packs[0].path = "...a/b..pack/.c";
  const AlignedBytes bytes = buildPack(fields);
  EXPECT_TRUE(PackFile::view(bytes.bytes(), "made.pack").has_value());
}

TEST(WorldCheck, RefusesWrongPaths) {
  const std::string upwards =
      "leads upwards with \"..\", expected a path below the world pack's folder";
  const std::string part = "has an empty part or \".\", expected names between '/'";
  refuse({
      path("", "is empty, expected the path of a pack"),
      path("/a.pack", "is absolute, expected a path relative to the world pack's folder"),
      path(std::string("a\0.pack", 7), "holds a zero byte, expected the path of a pack"),
      path("..", upwards),
      path("../a.pack", upwards),
      path("a/../b.pack", upwards),
      path("a/..", upwards),
      path("./a.pack", part),
      path("a//b.pack", part),
      path("a/", part),
      {"world.packs[1].path", "does not come after its predecessor, expected ascending paths",
       [](Fields& f) { f.packs[1].path = "episodes.pack"; }},
      {"world.packs[2].path", "does not come after its predecessor, expected ascending paths",
       [](Fields& f) { f.packs[2].path = "a.pack"; }},
  });
}

TEST(WorldCheck, RefusesWrongKindsSizesAndHashes) {
  refuse({
      {"world.packs[1].kind", "is \"OBJ\", expected SCEN, OBJS, RBOT, EPIS or TXTR",
       [](Fields& f) { f.packs[1].kind = "OBJ"; }},
      {"world.packs[1].kind", "is \"objs\", expected SCEN, OBJS, RBOT, EPIS or TXTR",
       [](Fields& f) { f.packs[1].kind = "objs"; }},
      {"world.packs[1].kind", "is \"WRLD\", expected no world in a world",
       [](Fields& f) { f.packs[1].kind = "WRLD"; }},
      {"world.packs[3].bytes", "is 64, expected more than the 64 of a pack's header",
       [](Fields& f) { f.packs[3].bytes = 64; }},
      {"world.packs[3].hash", "is missing, expected the file's hash",
       [](Fields& f) { f.packs[3].hash.reset(); }},
  });
}

TEST(WorldCheck, AcceptsWorldsThatLackAllButAScene) {
  // Removed one after the other from the front: episodes, objects, robot.
  Fields fields = smallWorldPack();
  while (fields.packs.size() > 1) {
    fields.packs.erase(fields.packs.begin());
    const AlignedBytes bytes = buildPack(fields);
    const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
    EXPECT_TRUE(pack.has_value()) << pack.error().text();
  }
}

TEST(WorldCheck, AcceptsTexturePacks) {
  Fields fields = smallWorldPack();
  fields.packs.push_back({.path = "textures/0a.pack", .kind = "TXTR"});
  fields.packs.push_back({.path = "textures/0b.pack", .kind = "TXTR"});
  const AlignedBytes bytes = buildPack(fields);
  EXPECT_TRUE(PackFile::view(bytes.bytes(), "made.pack").has_value());
}

TEST(WorldCheck, RefusesAListThatIsNoWorld) {
  refuse({
      {"world.packs", "has 2 robots (RBOT), expected at most one",
       [](Fields& f) { f.packs[1].kind = "RBOT"; }},
      {"world.packs", "has 2 episode sets (EPIS), expected at most one",
       [](Fields& f) { f.packs[1].kind = "EPIS"; }},
      {"world.packs", "has no scene (SCEN), expected at least one",
       [](Fields& f) { f.packs.pop_back(); }},
      {"world.packs", "has no scene (SCEN), expected at least one",
       [](Fields& f) { f.packs.clear(); }},
  });
}

WorldPackFields worldWithTask(TaskTexts task) {
  Fields fields = smallWorldPack();
  fields.task = std::move(task);
  return fields;
}

/// An offence of the second of three options of the task.
Offence option(const std::string& name, const std::string& value, const std::string& field,
               const std::string& message) {
  return {"world.task[1]." + field, message, [name, value](Fields& f) {
            f.task = TaskTexts{{"episode-steps", "300"}, {name, value}, {"slide-step", "0.05"}};
          }};
}

TEST(WorldCheck, AcceptsTaskOptionsInTheOrderOfTheTable) {
  for (const TaskTexts& task : {TaskTexts{}, TaskTexts{{"slide-step", "0.1"}},
                                TaskTexts{{"task", "pick"},
                                          {"episode-steps", "0"},
                                          {"safe-drop", "false"},
                                          {"slack-penalty", "-1e-3"},
                                          {"grasp-from", "2"},
                                          {"slide-direction", "towards-base"},
                                          {"place-jitter", "1000"}}}) {
    const AlignedBytes bytes = buildPack(worldWithTask(task));
    const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
    ASSERT_TRUE(pack.has_value()) << pack.error().text();
    const auto options = taskOptions(*pack);
    ASSERT_TRUE(options.has_value());
    ASSERT_EQ(options->size(), task.size());
    for (std::size_t n = 0; n < task.size(); ++n) {
      EXPECT_EQ((*options)[n].name, task[n].first);
      EXPECT_EQ((*options)[n].value, task[n].second);
    }
  }
}

TEST(WorldCheck, RefusesUnknownTaskOptions) {
  const std::string wanted = ", expected an option of the task, reward or robot of galactic-run";
  refuse({
      option("", "1", "name", "is \"\"" + wanted),
      option("wings", "1", "name", "is \"wings\"" + wanted),
      option("Safe-Drop", "true", "name", "is \"Safe-Drop\"" + wanted),
      option("--safe-drop", "true", "name", "is \"--safe-drop\"" + wanted),
      // Options of a batch, and of the command line alone.
      option("envs", "5", "name", "is \"envs\"" + wanted),
      option("seed", "5", "name", "is \"seed\"" + wanted),
      option("slide", "off", "name", "is \"slide\"" + wanted),
      option("threads", "5", "name", "is \"threads\"" + wanted),
  });
}

TEST(WorldCheck, RefusesTaskOptionsTwiceOrInAnotherOrder) {
  const std::string wanted = ", expected each option once, in the order of galactic-run's table";
  refuse({
      option("episode-steps", "300", "name", "is \"episode-steps\"" + wanted),
      option("task", "pick", "name", "is \"task\"" + wanted),
      {"world.task[2].name", "is \"slide-step\"" + wanted,
       [](Fields& f) {
         f.task = TaskTexts{{"episode-steps", "3"}, {"place-lift", "1"}, {"slide-step", "1"}};
       }},
  });
}

TEST(WorldCheck, RefusesWrongValuesOfTaskOptions) {
  const auto value = [](const std::string& name, const std::string& found,
                        const std::string& wanted) {
    return option(name, found, "value",
                  "is \"" + found + "\", expected " + wanted + " for " + name);
  };
  refuse({
      value("success-distance", "", "0 to 1000"),
      value("success-distance", "-0.1", "0 to 1000"),
      value("success-distance", "1000.5", "0 to 1000"),
      value("success-distance", "nan", "0 to 1000"),
      value("success-distance", "inf", "0 to 1000"),
      value("success-distance", "0x1", "0 to 1000"),
      value("success-distance", " 1", "0 to 1000"),
      value("success-distance", "1 m", "0 to 1000"),
      value("slide-attempts", "2.5", "0 to 1000"),
      value("slide-attempts", "-1", "0 to 1000"),
      value("slide-attempts", "1001", "0 to 1000"),
      value("slide-attempts", "99999999999999999999", "0 to 1000"),
      value("safe-drop", "yes", "true or false"),
      value("safe-drop", "1", "true or false"),
      value("slide-direction", "up", "glide or towards-base"),
      value("slide-direction", "", "glide or towards-base"),
      value("grasp-from", "2.5", "-2 to 2"),
      value("pick-reward", "1e7", "-1000000 to 1000000"),
  });
}

TEST(WorldCheck, RefusesTaskOptionsThatNobodyVerifiedWhenTheyAreRead) {
  const AlignedBytes bytes = buildPack(worldWithTask(TaskTexts{{"wings", "2"}}));
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack", Trust::kTrusted);
  ASSERT_TRUE(pack.has_value());
  const auto options = taskOptions(*pack);
  ASSERT_FALSE(options.has_value());
  EXPECT_EQ(options.error().where, "made.pack: world.task[0].name");
}

TEST(DamagedWorldPack, IsRefusedAtEachLengthOfATruncation) {
  expectEachTruncationRefused(buildPack(smallWorldPack()));
}

TEST(DamagedWorldPack, IsRefusedWithBytesTooMany) {
  expectBytesTooManyRefused(buildPack(smallWorldPack()));
}

TEST(DamagedWorldPack, IsRefusedAfterEachFlipOfASingleBit) {
  expectEachBitFlipRefused(buildPack(smallWorldPack()));
}

/// Reads the whole list; a sanitizer sees a read outside the pack.
void readEverything(const PackFile& pack) {
  const auto options = taskOptions(pack);
  ASSERT_TRUE(options.has_value());
  SimulationOptions ignored;
  ASSERT_FALSE(setOptions(*options, OptionScope::kTask, ignored));
  const auto references = packReferences(pack);
  ASSERT_TRUE(references.has_value());
  ASSERT_GE(references->size(), 3U);
  for (const PackReference& reference : *references) {
    ASSERT_FALSE(reference.path.empty());
    const std::filesystem::path path(reference.path);
    ASSERT_TRUE(path.is_relative());
    ASSERT_EQ(path, path.lexically_normal());
    ASSERT_NE(*path.begin(), "..");
    ASSERT_NE(reference.kind, PackKind::kWorld);
    ASSERT_GT(reference.bytes, sizeof(PackHeader));
  }
}

TEST(DamagedWorldPack, WithARecomputedHashIsRefusedOrSafeToReadAfterEachFlip) {
  expectFlipsWithARightHashRefusedOrUsable(buildPack(smallWorldPack()), PackKind::kWorld,
                                           readEverything);
}

TEST(DamagedWorldPack, WithATaskIsRefusedOrSafeToReadAfterEachFlip) {
  const WorldPackFields fields =
      worldWithTask({{"task", "pick"}, {"episode-steps", "300"}, {"safe-drop", "true"}});
  expectEachTruncationRefused(buildPack(fields));
  expectEachBitFlipRefused(buildPack(fields));
  expectFlipsWithARightHashRefusedOrUsable(buildPack(fields), PackKind::kWorld, readEverything);
}

}  // namespace
}  // namespace galactic::test::world_check_test
