#include "galactic/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "galactic/pack_reference.h"
#include "support/packs/world_pack_builder.h"

namespace galactic::test::world_test {
namespace {

namespace fs = std::filesystem;

Result<World> openWorld(const fs::path& path, Trust trust = Trust::kVerify) {
  return World::open(std::vector{path}, trust);
}

/// Bytes that stay where they are while packs view them.
struct WorldBytes {
  AlignedBytes scene, objects, robot, episodes;

  explicit WorldBytes(const WorldFields& fields)
      : scene(buildPack(fields.scene)),
        objects(buildPack(fields.objects)),
        robot(buildPack(fields.robot)),
        episodes(buildPack(fields.episodes)) {}
};

PackFile viewed(const AlignedBytes& bytes, const char* where) {
  Result<PackFile> pack = PackFile::view(bytes.bytes(), where);
  EXPECT_TRUE(pack.has_value()) << pack.error().text();
  return std::move(*pack);
}

std::vector<PackFile> packsOf(const WorldBytes& bytes) {
  std::vector<PackFile> packs;
  packs.push_back(viewed(bytes.scene, "kitchen.pack"));
  packs.push_back(viewed(bytes.objects, "objects.pack"));
  packs.push_back(viewed(bytes.robot, "helper.pack"));
  packs.push_back(viewed(bytes.episodes, "tidy.pack"));
  return packs;
}

void expectError(const Result<World>& world, const std::string& where, const std::string& message) {
  ASSERT_FALSE(world.has_value()) << "wanted: " << message;
  EXPECT_EQ(world.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(world.error().where, where);
  EXPECT_EQ(world.error().message, message);
}

/// Opens the world with this change.
void expectRefusedWorld(const std::function<void(WorldFields&)>& change, const std::string& where,
                        const std::string& message) {
  SCOPED_TRACE(message);
  WorldFields fields;
  change(fields);
  const WorldBytes bytes(fields);
  expectError(World::from(packsOf(bytes)), where, message);
}

void expectSmallWorld(const World& world) {
  ASSERT_EQ(world.scenes().size(), 1U);
  EXPECT_EQ(world.scenes()[0].name(), "kitchen");
  EXPECT_EQ(world.robot().name(), "helper");
  EXPECT_EQ(world.episodes().name(), "tidy");
  ASSERT_EQ(world.radii().size(), 2U);
  EXPECT_EQ(world.radii()[0], 0.5F);
  EXPECT_EQ(world.radii()[1], 0.75F);
  EXPECT_EQ(world.packs().size(), 4U);
  EXPECT_EQ(world.mostObjects(), 3U);
  const Episode& episode = world.episodes().episodes()[0];
  EXPECT_EQ(&world.sceneOf(episode), &world.scenes()[0]);
  const auto placements = world.episodes().placements(episode);
  EXPECT_EQ(world.objectOf(placements[0]).name, "bowl");
  EXPECT_EQ(world.objectOf(placements[1]).name, "mug");
  EXPECT_FALSE(world.objectOf(placements[1]).spheres.empty());
  // The joints "elbow" and "lift".
  ASSERT_EQ(world.startPositionIndices().size(), 2U);
  EXPECT_EQ(world.startPositionIndices()[0], 1U);
  EXPECT_EQ(world.startPositionIndices()[1], 0U);
}

TEST(World, OpensWhatAWorldPackLists) {
  const ScratchFolder folder;
  const fs::path path = writeWorld(folder, WorldFields{});
  for (const Trust trust : {Trust::kVerify, Trust::kTrusted}) {
    const Result<World> world = openWorld(path, trust);
    ASSERT_TRUE(world.has_value()) << world.error().text();
    expectSmallWorld(*world);
    EXPECT_EQ(world->packs()[2].where(), folder.path() / "robots/helper.pack");
  }
}

TEST(World, OpensThePacksThemselvesInAnyOrder) {
  const ScratchFolder folder;
  static_cast<void>(writePacks(folder, WorldFields{}));
  std::vector<fs::path> paths;
  for (const char* name :
       {"episodes.pack", "objects.pack", "robots/helper.pack", "scenes/kitchen.pack"}) {
    paths.push_back(folder.path() / name);
  }
  do {
    const Result<World> world = World::open(paths);
    ASSERT_TRUE(world.has_value()) << world.error().text();
    expectSmallWorld(*world);
  } while (std::next_permutation(paths.begin(), paths.end()));
}

TEST(World, IsToldFromOthersByItsPacksInAnyOrder) {
  const WorldBytes bytes{WorldFields{}};
  std::vector<PackFile> packs = packsOf(bytes);
  std::vector<PackFile> again = packsOf(bytes);
  std::ranges::reverse(again);
  const Result<World> world = World::from(std::move(packs));
  const Result<World> same = World::from(std::move(again));
  ASSERT_TRUE(world.has_value() && same.has_value());
  EXPECT_EQ(world->hash(), same->hash());

  WorldFields fields;
  fields.episodes.robot.clear();
  const WorldBytes others{fields};
  const Result<World> other = World::from(packsOf(others));
  ASSERT_TRUE(other.has_value()) << other.error().text();
  EXPECT_NE(world->hash(), other->hash());
}

TEST(World, StaysValidWhenItIsMoved) {
  const ScratchFolder folder;
  Result<World> world = openWorld(writeWorld(folder, WorldFields{}));
  ASSERT_TRUE(world.has_value());
  World moved = std::move(*world);
  world = fail(ErrorCode::kInternal, "", "");
  expectSmallWorld(moved);
  const World again(std::move(moved));
  expectSmallWorld(again);
}

TEST(World, StaysMappedAsLongAsACopyOfItLives) {
  const ScratchFolder folder;
  Result<World> world = openWorld(writeWorld(folder, WorldFields{}));
  ASSERT_TRUE(world.has_value());
  const World copy = *world;
  EXPECT_EQ(&copy.scenes(), &world->scenes());
  world = fail(ErrorCode::kInternal, "", "");
  expectSmallWorld(copy);
}

TEST(World, SortsItsScenesByNameWhateverTheOrderOfThePacks) {
  WorldFields fields;
  fields.episodes.scenes = {"attic", "kitchen"};
  fields.episodes.episodes[1].scene = 1;
  const WorldBytes bytes(fields);
  ScenePackFields attic = fields.scene;
  attic.name = "attic";
  const AlignedBytes other = buildPack(attic);
  for (const bool first : {true, false}) {
    std::vector<PackFile> packs = packsOf(bytes);
    packs.insert(first ? packs.begin() : packs.end(), viewed(other, "attic.pack"));
    const Result<World> world = World::from(std::move(packs));
    ASSERT_TRUE(world.has_value()) << world.error().text();
    EXPECT_EQ(world->scenes()[0].name(), "attic");
    EXPECT_EQ(world->scenes()[1].name(), "kitchen");
    EXPECT_EQ(world->sceneOf(world->episodes().episodes()[0]).name(), "attic");
    EXPECT_EQ(world->sceneIndexOf(world->episodes().episodes()[1]), 1U);
  }
}

TEST(World, TakesAnyRobotWhenTheEpisodesNameNone) {
  WorldFields fields;
  fields.episodes.robot.clear();
  fields.robot.name = "another";
  const WorldBytes bytes(fields);
  EXPECT_TRUE(World::from(packsOf(bytes)).has_value());
}

TEST(World, RefusesAMissingPack) {
  const ScratchFolder folder;
  const fs::path path = writeWorld(folder, WorldFields{});
  const fs::path missing = folder.path() / "objects.pack";
  fs::remove(missing);
  expectError(
      openWorld(path), path,
      "lists " + missing.string() + ", which is missing; put it there or link the world again");
}

TEST(World, RefusesAPackOfAnotherKindThanLinked) {
  const ScratchFolder folder;
  const fs::path path = writeWorld(folder, WorldFields{});
  const fs::path other = folder.write("objects.pack", textOf(buildPack(WorldFields{}.robot)));
  for (const Trust trust : {Trust::kVerify, Trust::kTrusted}) {
    expectError(openWorld(path, trust), path,
                "lists " + other.string() +
                    ", which is of kind RBOT, expected OBJS: it is not the pack that was linked; "
                    "link the world again");
  }
}

TEST(World, RefusesAPackOfAnotherSizeThanLinked) {
  const ScratchFolder folder;
  const WorldFields fields;
  const fs::path path = writeWorld(folder, fields);
  ObjectPackFields more = fields.objects;
  more.objects.emplace_back().name = "spoon";
  const AlignedBytes file = buildPack(more);
  const fs::path other = folder.write("objects.pack", textOf(file));
  for (const Trust trust : {Trust::kVerify, Trust::kTrusted}) {
    expectError(openWorld(path, trust), path,
                "lists " + other.string() + ", which has " + std::to_string(file.size()) +
                    " bytes, expected " + std::to_string(buildPack(fields.objects).size()) +
                    ": it is not the pack that was linked; link the world again");
  }
}

TEST(World, RefusesAPackWithAnotherHashThanLinkedUnlessItIsTrusted) {
  const ScratchFolder folder;
  WorldFields fields;
  const fs::path path = writeWorld(folder, fields);
  fields.objects.objects[0].box_half_extents->x = 0.125F;
  static_cast<void>(folder.write("objects.pack", textOf(buildPack(fields.objects))));
  const Result<World> world = openWorld(path);
  ASSERT_FALSE(world.has_value());
  EXPECT_EQ(world.error().where, path);
  EXPECT_NE(world.error().message.find("objects.pack, whose hash is "), std::string::npos);
  EXPECT_NE(
      world.error().message.find(": it is not the pack that was linked; link the world again"),
      std::string::npos);
  EXPECT_TRUE(openWorld(path, Trust::kTrusted).has_value());
}

TEST(World, RefusesALinkedPackThatIsDamaged) {
  const ScratchFolder folder;
  WorldFields fields;
  fields.objects.objects[0].name.clear();
  // Linked as it is, so that only the check of its values can refuse it.
  const fs::path path = writeWorld(folder, fields);
  expectError(openWorld(path),
              (folder.path() / "objects.pack").string() + ": objects.objects[0].name",
              "is empty, expected the object's name; bake the pack again");
}

TEST(World, TellsALinkedPackThatWasDamagedSinceFromAnotherOne) {
  const ScratchFolder folder;
  const WorldFields fields;
  const fs::path path = writeWorld(folder, fields);
  const AlignedBytes file = buildPack(fields.objects);
  std::string bytes(textOf(file));
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  const fs::path damaged = folder.write("objects.pack", bytes);
  const Result<World> world = openWorld(path);
  ASSERT_FALSE(world.has_value());
  EXPECT_EQ(world.error().name, "pack/hash");
  EXPECT_EQ(world.error().where, damaged);
  EXPECT_NE(world.error().message.find("the file is damaged, copy or bake it again"),
            std::string::npos);
}

TEST(World, RefusesATruncatedPack) {
  const ScratchFolder folder;
  const fs::path path = writeWorld(folder, WorldFields{});
  const fs::path cut = folder.path() / "objects.pack";
  fs::resize_file(cut, 100);
  const Result<World> world = openWorld(path);
  ASSERT_FALSE(world.has_value());
  EXPECT_EQ(world.error().where, cut);
}

TEST(World, TellsOfTheFirstOfSeveralTruncatedPacks) {
  const ScratchFolder folder;
  const fs::path path = writeWorld(folder, WorldFields{});
  const PackFile pack = PackFile::open(path).value();
  const std::vector<PackReference> listed = packReferences(pack).value();
  ASSERT_EQ(listed.size(), 4U);
  // Threads open them in any order.
  constexpr int kTries = 50;
  for (std::size_t first = listed.size(); first-- > 0;) {
    const fs::path cut = pathOf(listed[first], pack);
    fs::resize_file(cut, 100);
    for (int n = 0; n < kTries; ++n) {
      const Result<World> world = openWorld(path);
      ASSERT_FALSE(world.has_value());
      ASSERT_EQ(world.error().where, cut);
    }
  }
}

TEST(World, RefusesAWorldAmongOtherPacks) {
  const ScratchFolder folder;
  const fs::path path = writeWorld(folder, WorldFields{});
  const std::string message =
      "is a world pack among others; give one world pack alone, or the packs themselves";
  expectError(World::open(std::vector{path, folder.path() / "objects.pack"}), path, message);
  expectError(World::open(std::vector{path, path}), path, message);
}

TEST(World, RefusesAWorldThatLacksAKind) {
  const WorldBytes bytes{WorldFields{}};
  const std::vector<std::string> lacking{"scene (SCEN)", "", "robot (RBOT)", "episode set (EPIS)"};
  for (std::size_t n = 0; n < lacking.size(); ++n) {
    if (lacking[n].empty()) continue;
    std::vector<PackFile> packs = packsOf(bytes);
    packs.erase(packs.begin() + static_cast<std::ptrdiff_t>(n));
    expectError(World::from(std::move(packs)), "world",
                "has no " + lacking[n] + "; give a pack of one, too");
  }
  expectError(World::open(std::span<const std::filesystem::path>()), "world",
              "has no robot (RBOT); give a pack of one, too");
}

TEST(World, FitsTogetherWithoutRobotOrEpisodes) {
  const WorldBytes bytes{WorldFields{}};
  for (const std::size_t lacking : {2U, 3U}) {
    std::vector<PackFile> packs = packsOf(bytes);
    packs.erase(packs.begin() + static_cast<std::ptrdiff_t>(lacking));
    const auto fit = checkTogether(std::move(packs));
    EXPECT_TRUE(fit.has_value()) << fit.error().text();
  }
  std::vector<PackFile> scene_alone = packsOf(bytes);
  scene_alone.erase(scene_alone.begin() + 1, scene_alone.end());
  EXPECT_TRUE(checkTogether(std::move(scene_alone)).has_value());
}

TEST(World, PartialWorldsHaveOneSetOfRadiiAndUniqueNames) {
  WorldFields fields;
  fields.objects.radii.back() += 0.25F;
  const WorldBytes bytes{fields};
  const auto expect_refused = [](std::vector<PackFile> packs, const std::string& part) {
    const auto fit = checkTogether(std::move(packs));
    ASSERT_FALSE(fit.has_value());
    EXPECT_NE(fit.error().message.find(part), std::string::npos) << fit.error().message;
  };
  std::vector<PackFile> packs = packsOf(bytes);
  packs.erase(packs.begin() + 2, packs.end());
  expect_refused(std::move(packs), "bake them with the same --radii");
  const WorldBytes sound{WorldFields{}};
  packs = packsOf(sound);
  packs.erase(packs.begin() + 2, packs.end());
  packs.push_back(viewed(sound.scene, "more.pack"));
  expect_refused(std::move(packs), "has a second scene named \"kitchen\"");
}

TEST(World, WithAllItsPartsFitsTogetherAsItOpens) {
  WorldFields fields;
  EXPECT_TRUE(checkTogether(packsOf(WorldBytes{fields})).has_value());
  fields.episodes.objects[1] = "pan";
  const WorldBytes bytes{fields};
  EXPECT_FALSE(checkTogether(packsOf(bytes)).has_value());
}

TEST(World, RefusesWhatIsThereTwice) {
  const WorldBytes bytes{WorldFields{}};
  const std::string name = "; names must be unique in a world, leave one pack out";
  const auto with = [&](const AlignedBytes& more) {
    std::vector<PackFile> packs = packsOf(bytes);
    packs.push_back(viewed(more, "more.pack"));
    return World::from(std::move(packs));
  };
  expectError(with(bytes.robot), "more.pack",
              "has a second robot, the first is in helper.pack; a world has one, leave one out");
  expectError(
      with(bytes.episodes), "more.pack",
      "has a second episode set, the first is in tidy.pack; a world has one, leave one out");
  expectError(with(bytes.scene), "more.pack",
              "has a second scene named \"kitchen\", the first is in kitchen.pack" + name);
  expectError(with(bytes.objects), "more.pack",
              "has a second object named \"bowl\", the first is in objects.pack" + name);
}

TEST(World, RefusesEpisodesOfWhatIsNotThere) {
  const std::string joint =
      " of the robot \"helper\"; give the robot that the episodes were made for";
  const auto start_joint = [&](const std::string& name, const std::string& fault) {
    expectRefusedWorld([&](WorldFields& f) { f.episodes.start_joints[1] = name; },
                       "tidy.pack: episode_set.start_joints[1]",
                       "is \"" + name + "\", which " + fault + joint);
  };
  expectRefusedWorld([](WorldFields& f) { f.episodes.scenes.emplace_back("loft"); },
                     "tidy.pack: episode_set.scenes[1]",
                     "is \"loft\", which the world, with 1 scene, does not have; add its pack");
  expectRefusedWorld([](WorldFields& f) { f.episodes.objects[1] = "pan"; },
                     "tidy.pack: episode_set.objects[1]",
                     "is \"pan\", which the world, with 2 objects, does not have; add its pack");
  expectRefusedWorld(
      [](WorldFields& f) {
        f.episodes.objects[0] = "jug";
        f.episodes.objects[1] = "pan";
      },
      "tidy.pack: episode_set.objects[0]",
      "is \"jug\", which the world, with 2 objects, does not have, nor \"pan\"; add their packs");
  expectRefusedWorld(
      [](WorldFields& f) { f.episodes.robot = "fetch"; }, "tidy.pack: episode_set.robot",
      "is \"fetch\", the robot in helper.pack is \"helper\"; give the robot that the "
      "episodes were made for");
  start_joint("knee", "is not a joint");
  start_joint("hinge", "is not a joint with one position");
  start_joint("free", "is not a joint with one position");
  start_joint("grip", "follows another joint");
  expectRefusedWorld(
      [](WorldFields& f) {
        f.robot.links[4].multiplier = 1;
        f.episodes.start_joints[1] = "grip";
      },
      "tidy.pack: episode_set.start_joints[1]", "is \"grip\", which follows another joint" + joint);
  // A mimic that copies the joint exactly would still start one position twice.
  expectRefusedWorld(
      [](WorldFields& f) {
        f.robot.links[4].multiplier = 1;
        f.robot.links[4].offset = 0;
        f.episodes.start_joints[1] = "grip";
      },
      "tidy.pack: episode_set.start_joints[1]",
      "is \"grip\", which moves with an earlier start joint" + joint);
}

TEST(World, RefusesPacksOfOtherRadii) {
  const std::string same = "; bake them with the same --radii";
  expectRefusedWorld([](WorldFields& f) { f.objects.radii[1] = 0.8F; }, "objects.pack",
                     "was baked for the radii 0.5, 0.8 m, helper.pack for 0.5, 0.75 m" + same);
  expectRefusedWorld([](WorldFields& f) { f.scene.grids.pop_back(); }, "kitchen.pack",
                     "was baked for the radii 0.5 m, helper.pack for 0.5, 0.75 m" + same);
}

TEST(World, RefusesARobotThatCannotBeSimulated) {
  const std::string recipe = ", expected a robot to simulate; bake it with a recipe that has one";
  expectRefusedWorld([](WorldFields& f) { f.robot.end_effector.reset(); }, "helper.pack",
                     "has no end effector" + recipe);
  expectRefusedWorld([](WorldFields& f) { f.robot.base.reset(); }, "helper.pack",
                     "has no base" + recipe);
  expectRefusedWorld(
      [](WorldFields& f) {
        f.robot.spheres.clear();
        for (GroupFields& group : f.robot.groups) {
          group.first_sphere = 0;
          group.sphere_count = 0;
        }
      },
      "helper.pack",
      "has no spheres, expected a robot to simulate; bake it with collision geometry");
}

/// Opens a small world whose pack has this task.
Result<World> openWithTask(TaskTexts task, Trust trust = Trust::kVerify) {
  const ScratchFolder folder;
  WorldPackFields list = writePacks(folder, WorldFields{});
  list.task = std::move(task);
  return World::open(std::vector{folder.write("world.pack", textOf(buildPack(list)))}, trust);
}

TEST(WorldTask, IsWhatTheWorldPackSays) {
  const Result<World> world = openWithTask(
      {{"episode-steps", "300"}, {"safe-drop", "true"}, {"slide-direction", "towards-base"}});
  ASSERT_TRUE(world.has_value()) << world.error().text();
  EXPECT_EQ(world->taskOptions(),
            (std::vector<OptionText>{{"episode-steps", "300"},
                                     {"safe-drop", "true"},
                                     {"slide-direction", "towards-base", true}}));
  const SimulationOptions options = world->withTask();
  EXPECT_EQ(options.task.most_steps, 300U);
  EXPECT_FALSE(options.task.drop_fails);
  EXPECT_EQ(options.slide.direction, SlideDirection::kTowardsBase);
  // Nothing else changes.
  SimulationOptions wanted;
  wanted.task.most_steps = 300;
  wanted.task.drop_fails = false;
  wanted.slide.direction = SlideDirection::kTowardsBase;
  EXPECT_EQ(listOptions(options), listOptions(wanted));
}

TEST(WorldTask, LeavesWhatItDoesNotSayAsItWas) {
  const Result<World> world = openWithTask(TaskTexts{{"pick-reward", "0.25"}});
  ASSERT_TRUE(world.has_value());
  SimulationOptions base;
  base.envs = 7;
  base.task.pick_reward = 3;
  base.task.success_distance = 0.5F;
  const SimulationOptions options = world->withTask(base);
  base.task.pick_reward = 0.25F;
  EXPECT_EQ(listOptions(options), listOptions(base));
}

TEST(WorldTask, IsEmptyWhereThereIsNone) {
  const WorldBytes bytes{WorldFields{}};
  const Result<World> loose = World::from(packsOf(bytes));
  ASSERT_TRUE(loose.has_value());
  EXPECT_TRUE(loose->taskOptions().empty());
  EXPECT_EQ(listOptions(loose->withTask()), listOptions({}));
  const Result<World> silent = openWithTask({});
  ASSERT_TRUE(silent.has_value());
  EXPECT_TRUE(silent->taskOptions().empty());
}

TEST(WorldTask, IsCheckedInTrustedPacksToo) {
  for (const Trust trust : {Trust::kVerify, Trust::kTrusted}) {
    const Result<World> world = openWithTask(TaskTexts{{"episode-steps", "many"}}, trust);
    ASSERT_FALSE(world.has_value());
    EXPECT_EQ(world.error().code, ErrorCode::kInvalidInput);
    EXPECT_TRUE(world.error().where.ends_with("world.pack: world.task[0].value"))
        << world.error().where;
    EXPECT_EQ(world.error().message,
              "is \"many\", expected 0 to 1073741824 for episode-steps; bake the pack again");
  }
}

TEST(PackReferences, ShowTheListOfAWorldPackOnly) {
  const AlignedBytes bytes = buildPack(smallWorldPack());
  const PackFile world = viewed(bytes, "homes/world.pack");
  const auto references = packReferences(world);
  ASSERT_TRUE(references.has_value());
  ASSERT_EQ(references->size(), 4U);
  EXPECT_EQ((*references)[2].path, "robots/helper.pack");
  EXPECT_EQ((*references)[2].kind, PackKind::kRobot);
  EXPECT_EQ((*references)[2].bytes, 1000U);
  EXPECT_EQ((*references)[2].hash_low, 1U);
  EXPECT_EQ((*references)[2].hash_high, 2U);
  EXPECT_EQ(pathOf((*references)[2], world), "homes/robots/helper.pack");

  const AlignedBytes robot = buildPack(smallRobotPack());
  const PackFile helper = viewed(robot, "helper.pack");
  const auto none = packReferences(helper);
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().message,
            "is a pack of kind RBOT, expected a world (WRLD); give a world pack");
}

TEST(PackReferences, RefuseATrustedListWithoutAKindOrAHash) {
  const std::vector<std::function<void(WorldPackFields&)>> changes{
      [](WorldPackFields& f) { f.packs[0].kind = "ELSE"; },
      [](WorldPackFields& f) { f.packs[0].hash.reset(); }};
  for (const auto& change : changes) {
    WorldPackFields fields = smallWorldPack();
    change(fields);
    const AlignedBytes bytes = buildPack(fields);
    const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack", Trust::kTrusted);
    ASSERT_TRUE(pack.has_value());
    EXPECT_FALSE(packReferences(*pack).has_value());
  }
}

}  // namespace
}  // namespace galactic::test::world_test
