// Bakes of whole datasets that are killed, stopped, refused or run out of space.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <sstream>
#include <thread>
#include <utility>

#include "cli/plan_folder.h"
#include "galactic/error.h"
#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/files/part_files.h"
#include "support/mesh_files.h"
#include "support/recipe_text.h"

namespace galactic::test::plan_faults_cli_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

class PlanFaults : public PlanFolder {
 protected:
  [[nodiscard]] StartedProgram start(const std::string& out,
                                     const std::vector<std::string>& more) const {
    return {builtProgram("galactic-bake"), path(""), datasetArguments(out, more)};
  }
  [[nodiscard]] ProgramRun shell(const std::string& script) const {
    return runProgram("/bin/sh", path(""), {"-c", script});
  }
  /// Until one of the two scenes of a bake to "out" is there.
  void waitForAScene() const {
    const auto has_begun = [&] {
      return has("out/home/scenes/a.pack") || has("out/home/scenes/b.pack");
    };
    for (int n = 0; n < 5000 && !has_begun(); ++n) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
};

/// The unfinished files below `folder`.
std::vector<fs::path> partsBelow(const fs::path& folder) {
  std::vector<fs::path> parts;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().filename().string().find(".part-") != std::string::npos) {
      parts.push_back(entry.path());
    }
  }
  return parts;
}

TEST_F(PlanFaults, KilledAtAnyMomentItMakesTheSamePacksLater) {
  ASSERT_EQ(bake("whole", {"--no-cache"}).exit_code, 0);
  const PackContents whole = packsIn("whole");
  std::size_t killed = 0;
  for (const int milliseconds : {20, 150, 400, 700, 1000, 1500}) {
    const StartedProgram program = start("out", {"-j", "2"});
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    program.signal(SIGKILL);
    killed += program.wait().exit_code == -1 ? 1U : 0U;
    if (milliseconds == 400) fs::remove_all(path("out"));
  }
  EXPECT_GE(killed, 2U) << "it did not take long enough to be killed";
  const ProgramRun last = bake("out");
  ASSERT_EQ(last.exit_code, 0) << last.err;
  const PackContents found = packsIn("out");
  for (const auto& [name, bytes] : whole) {
    ASSERT_EQ(found.count(name), 1U) << name;
    EXPECT_TRUE(found.at(name) == bytes) << name;
  }
  EXPECT_THAT(partsBelow(path("out")), IsEmpty()) << "left by the killed ones";
  // Not even those leave a pack that is not whole.
  for (const auto& [name, bytes] : found) {
    const bool is_pack = name.ends_with(".pack");
    EXPECT_TRUE(!is_pack || whole.count(name) == 1) << name;
  }
}

TEST_F(PlanFaults, ClearsAwayWhatKilledRunsLeftBehindAndNothingElse) {
  ASSERT_EQ(bake("out", {"--scenes", "c", "--cache", path("cache").string()}).exit_code, 0);
  // As a killed run leaves them: in the world's folder, in the cache and beside the world pack.
  const std::vector<fs::path> stale{partPathOf(path("out/home/scenes/c.pack"), 0),
                                    partPathOf(path("out/home/textures/0.pack"), 1),
                                    partPathOf(path("cache/textures/0.pack"), 0),
                                    partPathOf(path("out/home.pack"), 0)};
  for (const fs::path& part : stale) write(fs::relative(part, path("")).string(), "half");
  // Another shard's, which is being written, another machine's, and what is none of this world's.
  const fs::path held = partPathOf(path("out/home/scenes/b.pack"), 0);
  write(fs::relative(held, path("")).string(), "half");
  const int descriptor = ::open(held.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_TRUE(holdPart(descriptor, held));
  const std::vector<std::string> others{"out/home/scenes/a.pack.part-0123456789abcdef-7-0",
                                        "out/other.pack.part-0123456789abcdef-7-0",
                                        "out/home/notes.part-1"};
  for (const std::string& other : others) write(other, "half");
  ASSERT_EQ(
      bake("out", {"--scenes", "c", "--cache", path("cache").string(), "--dry-run"}).exit_code, 0);
  for (const fs::path& part : stale) EXPECT_TRUE(fs::exists(part)) << part << ": a dry run";
  ASSERT_EQ(bake("out", {"--scenes", "c", "--cache", path("cache").string()}).exit_code, 0);
  for (const fs::path& part : stale) EXPECT_FALSE(fs::exists(part)) << part;
  EXPECT_TRUE(fs::exists(held));
  for (const std::string& other : others) EXPECT_TRUE(has(other)) << other;
  ::close(descriptor);
  ASSERT_EQ(bake("out", {"--scenes", "c", "--cache", path("cache").string()}).exit_code, 0);
  EXPECT_FALSE(fs::exists(held)) << "nobody writes it any more";
}

TEST_F(PlanFaults, WhereFilesMayNotGrowSaysSoAndLeavesOldPacksAsTheyWere) {
  ASSERT_EQ(bake("out", {"--scenes", "c"}).exit_code, 0);
  const PackContents before = packsIn("out");
  addScene("c", "flat", thing("mug", 3));
  std::string line = "ulimit -f 4; exec \"" + builtProgram("galactic-bake") + "\"";
  for (const std::string& word : datasetArguments("out", {"--scenes", "c"})) line += " " + word;
  const ProgramRun limited = shell(line);
  EXPECT_EQ(limited.exit_code, 2) << limited.err;
  EXPECT_THAT(limited.err, AllOf(HasSubstr("galactic-bake: out/home/"), HasSubstr("File too large"),
                                 HasSubstr("an existing file is left as it was")));
  expectSamePacks(packsIn("out"), before);
  EXPECT_THAT(partsBelow(path("out")), IsEmpty());
  // One pack alone, too.
  const std::string mesh = path("data/meshes/apartment.glb").string();
  const std::string alone =
      "\"" + builtProgram("galactic-bake") + "\" --check-columns 0 " + mesh + " -o one.pack";
  ASSERT_EQ(shell("exec " + alone + " --radii 0.05").exit_code, 0);
  const std::string one = content("one.pack");
  const ProgramRun refused = shell("ulimit -f 4; exec " + alone + " --radii 0.12");
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  EXPECT_THAT(refused.err, HasSubstr("one.pack: cannot write the file: File too large"));
  EXPECT_TRUE(content("one.pack") == one);
}

TEST_F(PlanFaults, BeginsAnewWithoutACacheAndSaysSo) {
  const StartedProgram program = start("out", {"-j", "1", "--no-cache"});
  waitForAScene();
  program.signal(SIGINT);
  const ProgramRun stopped = program.wait();
  EXPECT_EQ(stopped.exit_code, kExitInterrupted);
  EXPECT_THAT(stopped.out,
              HasSubstr("stopped; the same command begins anew, as there is no cache\n"));
}

TEST_F(PlanFaults, StopsBetweenPacksAndGoesOnLater) {
  ASSERT_EQ(bake("whole").exit_code, 0);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    fs::remove_all(path("out"));
    const StartedProgram program = start("out", {"-j", "1"});
    waitForAScene();
    program.signal(number);
    const ProgramRun stopped = program.wait();
    EXPECT_EQ(stopped.exit_code, kExitInterrupted);
    EXPECT_THAT(stopped.err, HasSubstr("finishing what has begun; once more to stop at once"));
    EXPECT_THAT(stopped.out, HasSubstr("stopped; the same command goes on from here\n"));
    EXPECT_EQ(report().at("run").at("stopped"), true);
    EXPECT_FALSE(has("out/home.pack"));
    const std::vector<std::string> done = packsThatAre("baked");
    EXPECT_THAT(done, Not(IsEmpty()));
    EXPECT_THAT(packsThatAre("planned"), Not(IsEmpty()));
    ASSERT_EQ(bake("out").exit_code, 0);
    EXPECT_EQ(packsThatAre("unchanged"), done);
    expectSamePacks(packsIn("out"), packsIn("whole"));
  }
}

/// A file that whoever opens it waits for, until it is let go of: by a lease on it, which the
/// kernel takes away after /proc/sys/fs/lease-break-time, 45 s.
class WithheldFile {
 public:
  explicit WithheldFile(const fs::path& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    // That somebody waits is told by a signal: one that is ignored.
    is_held_ = ::fcntl(descriptor_, F_SETSIG, SIGURG) == 0 &&
               ::fcntl(descriptor_, F_SETLEASE, F_WRLCK) == 0;
  }
  ~WithheldFile() { letGo(); }
  WithheldFile(const WithheldFile&) = delete;
  WithheldFile& operator=(const WithheldFile&) = delete;
  WithheldFile(WithheldFile&&) = delete;
  WithheldFile& operator=(WithheldFile&&) = delete;

  /// Not on all file systems.
  [[nodiscard]] bool isHeld() const { return is_held_; }
  [[nodiscard]] bool isWaitedFor() const {
    return descriptor_ >= 0 && ::fcntl(descriptor_, F_GETLEASE) != F_WRLCK;
  }
  void letGo() {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  }

 private:
  int descriptor_;
  bool is_held_ = false;
};

/// The processes that `parent` has started and that have not ended, ascending.
std::vector<pid_t> childrenOf(pid_t parent) {
  std::vector<pid_t> children;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    // "ID (NAME) STATE PARENT ..."
    const std::string status = fileContent(entry.path() / "stat");
    const std::size_t end_of_name = status.rfind(')');
    if (end_of_name == std::string::npos) continue;
    std::istringstream rest(status.substr(end_of_name + 1));
    char state = 0;
    pid_t its_parent = 0;
    rest >> state >> its_parent;
    if (its_parent == parent && state != 'Z') children.push_back(std::stoi(name));
  }
  std::ranges::sort(children);
  return children;
}

/// Looks again and again, for half a minute at most.
template <class Condition>
void waitFor(const Condition& condition) {
  for (int n = 0; n < 6000 && !condition(); ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST_F(PlanFaults, FinishesWhatAReaderIsAtWhenItsWholeGroupIsToldToEnd) {
  // Scenes with a box whose OBJ names an MTL, which none but the process that reads meshes opens
  // before the OBJ is read.
  write("data/objects/crate.object_config.json", R"({"render_asset": "../meshes/crate.obj"})");
  write("data/meshes/crate.mtl", "newmtl red\nKd 1 0 0\n");
  write("data/meshes/crate.obj", objFile(unevenBox(), "mtllib crate.mtl\nusemtl red\n"));
  addScene("f", "flat", thing("crate", 1));
  addScene("g", "flat", thing("crate", 2));
  const auto arguments = [](const std::string& out) {
    return datasetArguments(out, {"--scenes", "f", "--scenes", "g", "-j", "1"});
  };
  const ProgramRun whole = run(arguments("whole"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;

  WithheldFile materials(path("data/meshes/crate.mtl"));
  if (!materials.isHeld()) GTEST_SKIP() << "the file system has no leases";
  const StartedProgram program(builtProgram("galactic-bake"), path(""), arguments("out"), {},
                               ProgramGroup::kOwn);
  waitFor([&] { return materials.isWaitedFor(); });
  const std::vector<pid_t> readers = childrenOf(program.id());
  program.signalGroup(SIGINT);
  const auto has_noticed = [&] {
    return program.errSoFar().find("finishing what has begun") != std::string::npos;
  };
  waitFor(has_noticed);
  EXPECT_TRUE(has_noticed());
  EXPECT_TRUE(materials.isWaitedFor());
  // The signal came while it was there, and it is still there.
  EXPECT_THAT(readers, SizeIs(1));
  EXPECT_EQ(childrenOf(program.id()), readers);
  materials.letGo();
  const ProgramRun stopped = program.wait();
  EXPECT_EQ(stopped.exit_code, kExitInterrupted) << stopped.err;
  EXPECT_FALSE(has("out/home.pack"));
  EXPECT_THAT(partsBelow(path("out")), IsEmpty());
  const std::vector<std::string> done = packsThatAre("baked");
  EXPECT_THAT(done, SizeIs(1));
  EXPECT_THAT(packsThatAre("planned"), SizeIs(1));

  ASSERT_EQ(run(arguments("out")).exit_code, 0);
  EXPECT_EQ(packsThatAre("unchanged"), done);
  expectSamePacks(packsIn("out"), packsIn("whole"));
}

/// Bakes twice into a file system of its own, which is full the second time; "before" and "after"
/// get what was there. Ends with 77 where nothing may be mounted.
constexpr const char* kFullDisk = R"(
mkdir full && mount -t tmpfs -o size=16m tmpfs full || exit 77
$BAKE full/home.pack || exit 76
cp -r full before
dd if=/dev/zero of=full/ballast bs=4k 2> /dev/null
cp changed.json data/scenes/c.scene_instance.json
$BAKE full/home.pack
code=$?
rm full/ballast
cp -r full after
exit $code
)";

TEST_F(PlanFaults, OnAFullDiskSaysSoAndLeavesOldPacksAsTheyWere) {
  addScene("changed", "flat", thing("mug", 3));
  fs::rename(path("data/scenes/changed.scene_instance.json"), path("changed.json"));
  std::string bake = "BAKE=\"" + builtProgram("galactic-bake");
  std::vector<std::string> words = datasetArguments("full", {"--scenes", "c", "-o"});
  words.erase(words.begin() + 1, words.begin() + 3);
  for (const std::string& word : words) bake += " " + word;
  write("full.sh", bake + "\"" + kFullDisk);
  // A name space of mounts for root, one of users besides for others.
  ProgramRun full = shell("unshare -m sh full.sh");
  if (full.exit_code != 2) {
    fs::remove_all(path("full"));
    full = shell("unshare -rm sh full.sh");
  }
  if (!has("before")) GTEST_SKIP() << "no file system may be mounted here: " << full.err;
  EXPECT_EQ(full.exit_code, 2);
  EXPECT_THAT(full.err,
              AllOf(HasSubstr("galactic-bake: full/home/"), HasSubstr("No space left on device")));
  ASSERT_GE(packsIn("before").size(), 3U);
  expectSamePacks(packsIn("after"), packsIn("before"));
}

TEST_F(PlanFaults, ExplainsThatItCannotMakeItsFolder) {
  write("out/home", "no folder");
  const ProgramRun blocked = bake("out", {"--scenes", "c", "--no-cache"});
  EXPECT_EQ(blocked.exit_code, 2);
  EXPECT_THAT(blocked.err, HasSubstr("out/home: cannot be made a folder"));
  EXPECT_EQ(content("out/home"), "no folder");
  // Where nobody may write, root neither.
  const ProgramRun nowhere = bake("/proc/none", {"--scenes", "c"});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("/proc/none/home: cannot be made a folder"));
}

TEST_F(PlanFaults, TriesItsCacheBeforeItBakes) {
  write("out/home/.cache", "no folder");
  const ProgramRun beside = bake("out", {"--scenes", "c"});
  EXPECT_EQ(beside.exit_code, 2);
  EXPECT_THAT(beside.err, HasSubstr("out/home/.cache: cannot be made a folder"));
  EXPECT_THAT(beside.err, HasSubstr("; give another --cache\n"));
  const ProgramRun elsewhere = bake("out", {"--scenes", "c", "--cache", "/proc/none"});
  EXPECT_EQ(elsewhere.exit_code, 2);
  EXPECT_THAT(elsewhere.err, HasSubstr("/proc/none: cannot be made a folder"));
  EXPECT_FALSE(has("out/home/scenes"));
  const ProgramRun fresh = bake("new", {"--scenes", "c", "--cache", "/proc/none"});
  EXPECT_EQ(fresh.exit_code, 2);
  EXPECT_FALSE(has("new")) << "an empty folder is left";
  EXPECT_EQ(bake("out", {"--scenes", "c", "--dry-run"}).exit_code, 0) << "it writes nothing";
}

TEST_F(PlanFaults, MakesItsWorldWhereTheCacheCannotKeepIt) {
  ASSERT_EQ(bake("whole", {"--scenes", "c", "--no-cache"}).exit_code, 0);
  // What scenes share is kept there.
  write("cache/textures", "no folder");
  const ProgramRun baked = bake("out", {"--scenes", "c", "--cache", "cache"});
  EXPECT_EQ(baked.exit_code, 0) << baked.err;
  const std::string warning =
      "is not in the cache and will be baked again: cache/textures: cannot be made a folder: ";
  EXPECT_THAT(baked.out, HasSubstr("scenes/c.pack: " + warning));
  EXPECT_THAT(content("report.json"), HasSubstr(warning));
  EXPECT_THAT(packsThatAre("baked"), Contains("scenes/c.pack"));
  expectSamePacks(packsIn("out"), packsIn("whole"));
  ASSERT_EQ(bake("out", {"--scenes", "c", "--cache", "cache"}).exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), Contains("scenes/c.pack"));
}

TEST_F(PlanFaults, NamesTheTemplateThatHasNoMesh) {
  write("data/objects/crate.object_config.json", "{}");
  addScene("f", "flat", thing("crate", 1));
  const ProgramRun refused = bake("out", {"--scenes", "f"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("objects/crate.object_config.json: render_asset: it is "
                                     "missing; name the mesh to place\n"));
}

TEST_F(PlanFaults, RefusesOutputsThatAreInputsOrNoPack) {
  const std::string config = content("data/home.scene_dataset_config.json");
  const std::string mesh = content("data/meshes/apartment.glb");
  write("w.toml", "[[scenes]]\nfiles = \"data/meshes/apartment.glb\"\n");
  const std::string recipe = content("w.toml");
  const std::vector<Refusal> refusals{
      {{"w.toml", "-o", "w.toml"}, 3, "w.toml: is also an input; write to another file"},
      {{"w.toml", "-o", "data/meshes/apartment.glb"}, 3, "is also an input"},
      {{"w.toml", "--report", "w.toml"}, 3, "w.toml: is also an input"},
      {{"data/home.scene_dataset_config.json", "-o", "data/home.scene_dataset_config.json"},
       3,
       "is also an input"},
      {{"w.toml", "-o", "new"}, 3, "--out: is \"new\", expected NAME.pack, an existing folder"},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(testing::PrintToString(refusal.arguments));
    const ProgramRun refused = run(refusal.arguments);
    EXPECT_EQ(refused.exit_code, refusal.exit_code);
    EXPECT_THAT(refused.err, HasSubstr(refusal.part));
    EXPECT_THAT(refused.out, IsEmpty());
  }
  EXPECT_TRUE(content("data/home.scene_dataset_config.json") == config);
  EXPECT_TRUE(content("data/meshes/apartment.glb") == mesh);
  EXPECT_TRUE(content("w.toml") == recipe);
}

TEST_F(PlanFaults, RefusesRecipesThatDoNotFit) {
  const std::string scene = "[[scenes]]\nfiles = \"data/meshes/apartment.glb\"\n";
  write("twice.toml", scene + scene);
  write("far.toml", "[[scenes]]\nfiles = \"none/*.glb\"\n");
  write("option.toml", scene + "[[objects]]\nfiles = \"data/meshes/objects\"\nspacing = 1\n");
  write("value.toml", scene + "spacing = \"wide\"\n");
  write("robots.toml", scene + "[robot]\nfiles = \"*.toml\"\n");
  write("task.toml", scene + "[task]\nsafe-drop = true\nepisode-steps = -1\n");
  write("mesh.toml", scene + "[episodes]\ngeometry = { apartment = \"none.glb\" }\n");
  write("pack.toml", scene + "[episodes]\nfiles = \"value.toml\"\nobject-pack = \"none.pack\"\n");
  write("order.toml", "[bake]\nradii = [0.05, 0.015]\n" + scene);
  write("lost.toml", scene + "[robot]\nfiles = \"option.toml\"\nrecipe = \"none.toml\"\n");
  const std::string objects = "[[objects]]\nfiles = \"data/meshes/objects\"\n";
  write("bare.urdf", "<robot name=\"r\"><link name=\"base\"/></robot>");
  const std::string robot = "[robot]\nfiles = \"bare.urdf\"\n";
  write("nobody.toml", scene + objects + "[episodes]\ncount = 2\n");
  write("nothing.toml", scene + robot + "[episodes]\ncount = 2\n");
  write("baseless.toml", scene + objects + robot + "[episodes]\ncount = 2\n");
  write("radii.toml", scene + "radii = [0.05]\n" + objects);
  const std::vector<Refusal> refusals{
      {{"nobody.toml"},
       3,
       "nobody.toml:5: episodes are generated for a robot and objects, and "
       "there is no [robot]; add it"},
      {{"nothing.toml"},
       3,
       "nothing.toml:5: episodes are generated for a robot and objects, and "
       "there is no [[objects]]; add it"},
      {{"baseless.toml"},
       3,
       "baseless.toml:7: episodes are generated for a robot and objects, and "
       "there is no [robot] with a recipe; add it"},
      {{"radii.toml"}, 3, "objects/"},
      {{"radii.toml", "--dry-run"},
       3,
       "give all packs of a world the same --radii, best in [bake]"},
      {{"twice.toml"}, 3, "would be scenes/apartment.pack, as "},
      {{"far.toml"}, 2, "far.toml:1: none/*.glb: fits no file in "},
      {{"option.toml"}, 3, "option.toml:5: spacing: does not go with --as object"},
      {{"value.toml"}, 3, "value.toml:3: spacing: found wide, expected a number above 0"},
      {{"order.toml"},
       3,
       "order.toml:2: radii: has 0.015 m after 0.05 m; list each radius once, in ascending order"},
      {{"robots.toml"}, 3, "robots.toml:3: [robot] names "},
      {{"lost.toml"}, 2, "lost.toml:5: recipe: none.toml fits no file in "},
      {{"none.toml"}, 2, "none.toml"},
      {{"task.toml"},
       3,
       "task.toml:5: task.episode-steps: found -1, expected a whole number from 0 to 1073741824"},
      {{"mesh.toml"}, 2, "mesh.toml:4: geometry: none.glb fits no file in "},
      {{"pack.toml"}, 2, "pack.toml:5: object-pack: none.pack fits no file in "},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(testing::PrintToString(refusal.arguments));
    const ProgramRun refused = run(refusal.arguments);
    EXPECT_EQ(refused.exit_code, refusal.exit_code);
    EXPECT_THAT(refused.err, HasSubstr(refusal.part));
  }
}

TEST_F(PlanFaults, RefusesWrongOptions) {
  const std::vector<Refusal> refusals{
      {{"--shard", "0/2"}, 1, "--shard: is \"0/2\", expected I/N with I from 1 to N"},
      {{"--shard", "3/2"}, 1, "--shard: is \"3/2\""},
      {{"--shard", "1"}, 1, "--shard: is \"1\""},
      {{"--shard", "1/2x"}, 1, "--shard: is \"1/2x\""},
      {{"--memory", "0"}, 1, "--memory"},
      {{"--cache", "c", "--no-cache"}, 1, "--no-cache: does not go with --cache; give one"},
      {{"--missing", "ignore"}, 1, "--missing"},
      {{"--eps", "0.1"}, 1, "--eps: does not go with --as dataset"},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(testing::PrintToString(refusal.arguments));
    const ProgramRun refused = bake("out", refusal.arguments);
    EXPECT_EQ(refused.exit_code, refusal.exit_code);
    EXPECT_THAT(refused.err, HasSubstr(refusal.part));
  }
  EXPECT_FALSE(has("out"));
}

TEST_F(PlanFaults, RefusesTheFolderOfADatasetThatComposesScenes) {
  for (const char* option : {"--list", "--dry-run"}) {
    const ProgramRun refused = run({"data", "--as", "dataset", option});
    EXPECT_EQ(refused.exit_code, 3) << option;
    EXPECT_THAT(refused.err,
                HasSubstr("data: found the folder of a dataset whose scenes are composed of its "
                          "meshes, wanted one of scans; give data/home.scene_dataset_config.json"));
  }
  EXPECT_FALSE(has("data.pack"));
}

TEST_F(PlanFaults, GoesOnAfterAnErrorWhereTheUserWants) {
  write("data/meshes/objects/mug.glb", "no mesh");
  const ProgramRun stops = bake("out", {"-j", "1", "--missing", "skip"});
  EXPECT_EQ(stops.exit_code, 3);
  EXPECT_THAT(stops.err, HasSubstr("mug.glb"));
  EXPECT_THAT(packsThatAre("failed"), SizeIs(1));
  EXPECT_FALSE(has("out/home.pack"));
  const ProgramRun goes_on = bake("out", {"-j", "1", "--missing", "skip", "--keep-going"});
  EXPECT_EQ(goes_on.exit_code, 3);
  EXPECT_THAT(packsThatAre("failed"), SizeIs(2));
  EXPECT_THAT(packsThatAre("baked").size() + packsThatAre("unchanged").size(), 2U);
  EXPECT_TRUE(has("out/home.pack"));
}

TEST_F(PlanFaults, FailsNoSceneForTheMeshOfWhatMovesInIt) {
  write("data/meshes/objects/mug.glb", "no mesh");
  addScene("c", "flat", R"({"template_name": "mug", "motion_type": "DYNAMIC"})");
  const ProgramRun goes_on = bake("out", {"--scenes", "c", "--keep-going"});
  EXPECT_EQ(goes_on.exit_code, 3);
  EXPECT_THAT(packsThatAre("failed"), testing::ElementsAre("objects/mug.pack"));
  EXPECT_THAT(packsThatAre("baked"), testing::ElementsAre("scenes/c.pack"));
  const ProgramRun looks = bake("out", {"--scenes", "c", "--dry-run"});
  EXPECT_THAT(looks.out, HasSubstr("missing:\n  objects/mug.pack: " + path("data").string()));
}

TEST_F(PlanFaults, GoesOnWithoutScenesWhoseFilesAreBroken) {
  write("data/scenes/b.scene_instance.json", "{\"stage_instance\": ");
  const ProgramRun stops = bake("out", {"--missing", "skip"});
  EXPECT_EQ(stops.exit_code, 3);
  EXPECT_THAT(stops.err, HasSubstr("b.scene_instance.json: it is not JSON"));
  EXPECT_FALSE(has("out"));
  const ProgramRun looks = bake("out", {"--missing", "skip", "--dry-run"});
  EXPECT_EQ(looks.exit_code, 3);
  EXPECT_THAT(looks.err, HasSubstr("b.scene_instance.json: it is not JSON"));
  EXPECT_THAT(looks.out, HasSubstr("scenes/b.pack"));
  EXPECT_THAT(looks.out, Not(HasSubstr("nothing is missing")));
  EXPECT_THAT(packsThatAre("planned"), Contains("scenes/c.pack"));
  const ProgramRun goes_on = bake("out", {"--missing", "skip", "--keep-going"});
  EXPECT_THAT(goes_on.out, HasSubstr("[4/4] "));
  EXPECT_EQ(goes_on.exit_code, 3);
  EXPECT_THAT(goes_on.err, HasSubstr("b.scene_instance.json: it is not JSON"));
  EXPECT_THAT(packsThatAre("failed"), testing::ElementsAre("scenes/b.pack"));
  EXPECT_THAT(packsThatAre("baked"), SizeIs(3));
  EXPECT_TRUE(has("out/home.pack"));
}

TEST_F(PlanFaults, MakesEpisodesOfWhatIsThere) {
  write("data/broken.glb", "no mesh");
  const auto recipeOf = [](const std::string& robot) {
    std::string text = quickRecipe("files = [\"apartment.glb\", \"data/broken.glb\"]", "count = 2");
    const std::string porter = "robot/porter.urdf";
    text.replace(text.find(porter), porter.size(), robot);
    return text;
  };
  const auto made = [this](const std::string& recipe) {
    return run({recipe, "--data", sampleFile(""), "--keep-going", "--report", "report.json"});
  };
  write("home.toml", recipeOf("robot/porter.urdf"));
  EXPECT_EQ(made("home.toml").exit_code, 3);
  EXPECT_THAT(packsThatAre("failed"), testing::ElementsAre("scenes/broken.pack"));
  EXPECT_THAT(packsThatAre("baked"), Contains("episodes.pack"));
  EXPECT_TRUE(has("home.pack"));
  write("data/none.urdf", "<robot");
  write("lost.toml", recipeOf("data/none.urdf"));
  const ProgramRun lost = made("lost.toml");
  EXPECT_EQ(lost.exit_code, 3);
  EXPECT_THAT(lost.err, HasSubstr("episodes.pack: is not made, as robot.pack is not there"));
  EXPECT_THAT(packsThatAre("failed"), Contains("episodes.pack"));
}

TEST_F(PlanFaults, MakesPacksAgainThatWereDamaged) {
  ASSERT_EQ(bake("out", {"--scenes", "c"}).exit_code, 0);
  const PackContents before = packsIn("out");
  // Once as an editor does it, with a new file, once in place, where the cache has the same file.
  damage("out/home/scenes/c.pack");
  ASSERT_EQ(bake("out", {"--scenes", "c"}).exit_code, 0);
  EXPECT_THAT(packsThatAre("unchanged"), Contains("scenes/c.pack"));
  expectSamePacks(packsIn("out"), before);
  fs::resize_file(path("out/home/scenes/c.pack"), 100);
  ASSERT_EQ(bake("out", {"--scenes", "c"}).exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), Contains("scenes/c.pack"));
  expectSamePacks(packsIn("out"), before);
}

}  // namespace
}  // namespace galactic::test::plan_faults_cli_test
