// What check says of packs: codes, order, folders, reports.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <regex>
#include <set>
#include <sstream>

#include "pack_tool/check/finding.h"
#include "pack_tool/check/junit.h"
#include "pack_tool/describe/pack_description.h"
#include "pack_tool/support/xml_text.h"
#include "pack_tool/verbs/verbs.h"
#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/pack_tool_fixture.h"
#include "support/packs/world_pack_builder.h"
#include "support/program_run.h"

namespace galactic::pack_tool::check_test {
namespace {

using test::EpisodePackFields;
using test::ScenePackFields;
using test::ScratchFolder;
using test::WorldFields;
using testing::ElementsAre;
using testing::HasSubstr;

struct Outcome {
  int exit_code = 0;
  std::string out;
  std::string err;
};

Outcome check(CheckOptions options) {
  std::ostringstream out;
  std::ostringstream err;
  const int exit_code = runCheck(options, Console{out, err});
  return {exit_code, out.str(), err.str()};
}

/// The code of the only finding in a file of these bytes.
std::string codeOf(std::string_view bytes) {
  const ScratchFolder folder;
  const Outcome outcome =
      check({.packs = {folder.write("made.pack", bytes)}, .form = OutputForm::kJson});
  const Json entry = Json::parse(outcome.out).at(0);
  EXPECT_EQ(entry.at("ok"), false);
  const std::string code = entry.value("code", "");
  EXPECT_THAT(outcome.err, testing::EndsWith(" [" + code + "]\n")) << "text has the code, too";
  return code;
}

template <class Fields>
std::string codeAfter(Fields fields, const std::function<void(Fields&)>& change) {
  change(fields);
  return codeOf(test::asText(test::buildPack(fields).bytes()));
}

/// The bytes of a good pack, to be damaged.
std::string goodBytes() {
  return std::string(test::asText(test::buildPack(test::kitchenScene()).bytes()));
}

/// A pack with this payload whose header is right.
std::string withPayload(std::span<const std::byte> payload) {
  return std::string(test::asText(test::packFile(PackKind::kScene, payload).bytes()));
}

TEST(FindingCodes, TellEveryDamageOfAFileApart) {
  const std::string good = goodBytes();
  const auto changed = [&good](std::size_t at, char value) {
    std::string bytes = good;
    bytes[at] = value;
    return codeOf(bytes);
  };
  constexpr std::size_t kVersion = 8;
  constexpr std::size_t kKind = 12;
  constexpr std::size_t kReserved = 40;
  EXPECT_EQ(codeOf(good.substr(0, 63)), "pack/truncated");
  EXPECT_EQ(codeOf(""), "pack/truncated");
  EXPECT_EQ(codeOf(good.substr(0, good.size() - 1)), "pack/size");
  EXPECT_EQ(codeOf(good + "x"), "pack/size");
  EXPECT_EQ(changed(0, 'x'), "pack/not-a-pack");
  EXPECT_EQ(changed(kVersion, 99), "pack/version-new");
  EXPECT_EQ(changed(kVersion, 0), "pack/version-old");
  EXPECT_EQ(changed(kKind, 'x'), "pack/kind");
  EXPECT_EQ(changed(kReserved, 'x'), "pack/reserved");
  EXPECT_EQ(changed(good.size() - 1, static_cast<char>(good.back() ^ 1)), "pack/hash");
  const std::vector<std::byte> zeros(64);
  EXPECT_EQ(codeOf(withPayload(zeros)), "pack/identifier");
  std::string broken = good.substr(sizeof(PackHeader));
  broken[0] = static_cast<char>(0xf0);
  EXPECT_EQ(codeOf(withPayload(std::as_bytes(std::span(broken)))), "pack/structure");
  EXPECT_EQ(
      codeAfter<ScenePackFields>(test::kitchenScene(), [](auto& f) { f.kind = PackKind::kRobot; }),
      "pack/asset");
}

TEST(FindingCodes, NameTheFieldThatOffends) {
  const auto scene = [](const std::function<void(ScenePackFields&)>& change) {
    return codeAfter<ScenePackFields>(test::kitchenScene(), change);
  };
  EXPECT_EQ(scene([](auto& f) { f.name.clear(); }), "scene/name");
  EXPECT_EQ(scene([](auto& f) { f.tool.clear(); }), "provenance/tool");
  EXPECT_EQ(scene([](auto& f) { f.source_name = "/x.glb"; }), "provenance/sources.name");
  EXPECT_EQ(scene([](auto& f) { f.grids[1].grid.spec.radius = -1; }), "scene/column_grids.radius");
  EXPECT_EQ(scene([](auto& f) { f.grids[0].grid.cells[0] = ~std::uint64_t{0}; }),
            "scene/column_grids.cells");
  const auto episodes = [](const std::function<void(EpisodePackFields&)>& change) {
    return codeAfter<EpisodePackFields>(test::smallEpisodes(), change);
  };
  EXPECT_EQ(episodes([](auto& f) { f.objects = {"mug", "bowl"}; }), "episode_set/objects");
  EXPECT_EQ(episodes([](auto& f) { f.episodes[1].target = 7; }), "episode_set/episodes.target");
  EXPECT_EQ(episodes([](auto& f) { f.placements[2].object = 7; }), "episode_set/placements.object");
}

TEST(FindingCodes, TellWhatIsWrongWithAWorld) {
  const auto code = [](const std::function<void(WorldFields&)>& change) {
    const ScratchFolder folder;
    WorldFields fields;
    change(fields);
    const auto path = test::writeWorld(folder, fields);
    return Json::parse(check({.packs = {path}, .form = OutputForm::kJson}).out)
        .at(0)
        .value("code", "");
  };
  EXPECT_EQ(code([](auto&) {}), "");
  EXPECT_EQ(code([](auto& f) { f.episodes.objects[1] = "pan"; }), "world/unknown-object");
  EXPECT_EQ(code([](auto& f) { f.episodes.scenes[0] = "attic"; }), "world/unknown-scene");
  EXPECT_EQ(code([](auto& f) { f.episodes.robot = "other"; }), "world/other-robot");
  EXPECT_EQ(code([](auto& f) { f.episodes.start_joints[0] = "wing"; }), "world/other-robot");
  EXPECT_EQ(code([](auto& f) { f.objects.radii[0] = 0.4F; }), "world/other-radii");

  const ScratchFolder folder;
  const auto path = test::writeWorld(folder, WorldFields{});
  std::filesystem::remove(folder.path() / "objects.pack");
  static_cast<void>(folder.write("scenes/kitchen.pack", goodBytes()));
  const Json world = Json::parse(check({.packs = {path}, .form = OutputForm::kJson}).out).at(0);
  EXPECT_EQ(world.at("code"), "world/bad-pack");
  EXPECT_EQ(world.at("packs").at(1).at("code"), "world/missing-pack");
  EXPECT_EQ(world.at("packs").at(3).at("code"), "world/other-pack");
}

TEST(FindingCodes, CallAPackThatAWorldListsDamagedWhereItIs) {
  const ScratchFolder folder;
  const auto path = test::writeWorld(folder, WorldFields{});
  std::string bytes = test::fileContent(folder.path() / "objects.pack");
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  static_cast<void>(folder.write("objects.pack", bytes));
  const Outcome outcome = check({.packs = {path}, .form = OutputForm::kJson});
  const Json world = Json::parse(outcome.out).at(0);
  EXPECT_EQ(world.at("packs").at(1).at("code"), "pack/hash");
  EXPECT_THAT(world.dump(), testing::Not(HasSubstr("link the world again")));
}

TEST(FindingCodes, TellFilesThatAreNone) {
  const ScratchFolder folder;
  const auto code = [](const std::filesystem::path& path) {
    return Json::parse(check({.packs = {path}, .form = OutputForm::kJson}).out)
        .at(0)
        .at("code")
        .get<std::string>();
  };
  EXPECT_EQ(code(folder.path() / "none.pack"), "file/unreadable");
  EXPECT_EQ(code("/dev/null"), "file/not-regular");
  EXPECT_EQ(code(folder.path()), "file/no-packs");
}

TEST(Folders, AreSearchedButForHiddenOnes) {
  const ScratchFolder folder;
  static_cast<void>(folder.write("home/scenes/kitchen.pack", goodBytes()));
  static_cast<void>(folder.write("home/.cache/kept/half.pack", "GALA"));
  static_cast<void>(folder.write(".half.pack", "GALA"));
  const Outcome outcome = check({.packs = {folder.path()}});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::EndsWith("home/scenes/kitchen.pack: ok\n"));
  EXPECT_THAT(outcome.out, testing::Not(HasSubstr("half.pack")));
}

/// The names of errors in all sources below a folder.
std::set<std::string> namesIn(const std::filesystem::path& folder) {
  static const std::regex kName(R"re("((file|pack|world)/[a-z-]+)")re");
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string source = test::fileContent(entry.path());
    for (std::sregex_iterator one(source.begin(), source.end(), kName), end; one != end; ++one) {
      names.insert((*one)[1].str());
    }
  }
  return names;
}

TEST(FindingCodes, AreThoseOfTheDocument) {
  std::set<std::string> named = namesIn(test::sourceFolder() / "runtime/src");
  named.merge(namesIn(test::sourceFolder() / "pack_tool"));
  named.erase("pack/other");
  const std::string document = test::fileContent(test::sourceFolder() / "docs/ci.md");
  static const std::regex kRow(R"re(\| `((file|pack|world)/[a-z-]+)` \|)re");
  std::set<std::string> listed;
  for (std::sregex_iterator one(document.begin(), document.end(), kRow), end; one != end; ++one) {
    EXPECT_TRUE(listed.insert((*one)[1].str()).second) << (*one)[1].str();
  }
  EXPECT_GE(listed.size(), 25U);
  EXPECT_EQ(named, listed);
}

TEST(FindingCodes, AreTheNamesOfErrorsElseOfFields) {
  const auto code = [](const std::string& where, std::string_view name) {
    return findingCode({ErrorCode::kInvalidInput, where, "is odd", name}, "a.pack");
  };
  EXPECT_EQ(code("a.pack", "pack/hash"), "pack/hash");
  EXPECT_EQ(code("a.pack: episode_set.scenes[2]", "world/unknown-scene"), "world/unknown-scene");
  EXPECT_EQ(code("a.pack: scene.column_grids[1].cells[7]", ""), "scene/column_grids.cells");
  EXPECT_EQ(code("a.pack", ""), "pack/other");
  EXPECT_EQ(code("a.pack: No Element", ""), "pack/other");
  EXPECT_EQ(findingCode({ErrorCode::kInternal, "a.pack", "has type 3", "pack/asset"}, "a.pack"),
            "internal/error");
}

/// A folder with good and bad packs in several places.
class CheckMany : public testing::Test {
 protected:
  void SetUp() override {
    const std::string good = goodBytes();
    for (int n = 0; n < 40; ++n) {
      const std::string name = "room" + std::to_string(n) + ".pack";
      const bool bad = n % 3 == 0;
      packs_.push_back(folder_.write(name, bad ? good.substr(0, 400) : good));
    }
    static_cast<void>(folder_.write("below/deep/good.PACK", good));
    static_cast<void>(folder_.write("below/notes.txt", "no pack"));
  }

  ScratchFolder folder_;
  std::vector<std::filesystem::path> packs_;
};

TEST_F(CheckMany, SaysTheSameInTheGivenOrderOnAnyNumberOfThreads) {
  std::reverse(packs_.begin(), packs_.end());
  const Outcome one = check({.packs = packs_, .form = OutputForm::kJson, .threads = 1});
  const Json report = Json::parse(one.out);
  ASSERT_EQ(report.size(), packs_.size());
  std::size_t good = 0;
  for (std::size_t n = 0; n < packs_.size(); ++n) {
    EXPECT_EQ(report.at(n).at("file"), packs_[n].string());
    if (report.at(n).at("ok") == true) ++good;
  }
  EXPECT_GT(good, packs_.size() / 10);
  EXPECT_LT(good, packs_.size() * 9 / 10);
  for (const unsigned threads : {0U, 2U, 7U, 100U}) {
    const Outcome many = check({.packs = packs_, .form = OutputForm::kJson, .threads = threads});
    EXPECT_EQ(many.out, one.out);
    EXPECT_EQ(many.err, one.err);
    EXPECT_EQ(many.exit_code, one.exit_code);
  }
}

TEST_F(CheckMany, SearchesFoldersInTheOrderOfTheirPaths) {
  const Outcome outcome = check({.packs = {folder_.path()}, .form = OutputForm::kJson});
  std::vector<std::string> files;
  for (const Json& entry : Json::parse(outcome.out)) files.push_back(entry.at("file"));
  EXPECT_EQ(files.size(), packs_.size() + 1);
  EXPECT_TRUE(std::is_sorted(files.begin(), files.end()));
  EXPECT_THAT(files.front(), HasSubstr("below/deep/good.PACK"));
  EXPECT_EQ(outcome.exit_code, static_cast<int>(ErrorCode::kInvalidInput));
}

TEST_F(CheckMany, ChecksAPackOnceHoweverOftenItIsNamed) {
  const auto& bad = packs_[0];
  const auto& good = packs_[1];
  const Outcome outcome = check({.packs = {good, bad, folder_.path() / "below/../room1.pack",
                                           folder_.path() / "below", bad, folder_.path() / "below"},
                                 .form = OutputForm::kJson});
  std::vector<std::string> files;
  for (const Json& entry : Json::parse(outcome.out)) files.push_back(entry.at("file"));
  EXPECT_THAT(files, ElementsAre(good.string(), bad.string(),
                                 (folder_.path() / "below/deep/good.PACK").string()));
}

TEST(CheckWorlds, TellsOnceOfAPackThatWorldsList) {
  const ScratchFolder folder;
  const auto world = test::writeWorld(folder, WorldFields{});
  const auto same = folder.path() / "zz-again.pack";
  std::filesystem::copy_file(world, same);
  static_cast<void>(folder.write("alone.pack", goodBytes()));
  const auto packs_in = [](const Outcome& outcome) {
    std::multiset<std::string> lines;
    std::istringstream text(outcome.out);
    for (std::string line; std::getline(text, line);) lines.insert(line);
    return lines;
  };
  const std::multiset<std::string> told = packs_in(check({.packs = {folder.path()}}));
  // Two worlds, their four packs, and one that no world lists.
  EXPECT_EQ(told.size(), 7U);
  EXPECT_EQ(std::set<std::string>(told.begin(), told.end()).size(), told.size());
  // A pack that is named beside its world, too.
  const Outcome named = check({.packs = {folder.path() / "objects.pack", world}});
  EXPECT_EQ(packs_in(named).count((folder.path() / "objects.pack").string() + ": ok"), 1U);
  // A bad pack: its error, and that of each world.
  static_cast<void>(folder.write("objects.pack", "short"));
  const Outcome bad = check({.packs = {world, folder.path() / "objects.pack"}});
  EXPECT_EQ(bad.exit_code, static_cast<int>(ErrorCode::kInvalidInput));
  EXPECT_EQ(std::ranges::count(bad.err, '\n'), 2);
  const Json json = Json::parse(check({.packs = {folder.path()}, .form = OutputForm::kJson}).out);
  EXPECT_EQ(json.size(), 3U) << "the worlds with their packs, and what no world lists";
}

TEST(JUnit, HasACaseForEachPackAndAFailureForEachBadOne) {
  CheckedPack good;
  good.file = "room.pack";
  const CheckedPack bad =
      badPack("cut.pack", {ErrorCode::kInvalidInput, "cut.pack",
                           "has 3 bytes, a pack has at least 64; it is truncated or no pack",
                           "pack/truncated"});
  CheckedPack world =
      badPack("world.pack", {ErrorCode::kInvalidInput, "world.pack",
                             "lists 1 pack, 1 of them bad; see above", "world/bad-pack"});
  world.is_world = true;
  world.listed = {bad};
  EXPECT_EQ(junitText({good, world}),
            R"(<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="galactic-pack check" tests="3" failures="2" errors="0">
  <testsuite name="galactic-pack check" tests="3" failures="2" errors="0">
    <testcase classname="packs" name="room.pack"/>
    <testcase classname="world.pack" name="cut.pack">
      <failure type="pack/truncated" message="has 3 bytes, a pack has at least 64; it is truncated or no pack">cut.pack: has 3 bytes, a pack has at least 64; it is truncated or no pack [pack/truncated]</failure>
    </testcase>
    <testcase classname="packs" name="world.pack">
      <failure type="world/bad-pack" message="lists 1 pack, 1 of them bad; see above">world.pack: lists 1 pack, 1 of them bad; see above [world/bad-pack]</failure>
    </testcase>
  </testsuite>
</testsuites>
)");
}

TEST(JUnit, EscapesWhatXmlCannotHold) {
  EXPECT_EQ(xmlEscaped("a<b>&\"c'"), "a&lt;b&gt;&amp;&quot;c&apos;");
  EXPECT_EQ(xmlEscaped("k\xc3\xbc"
                       "che \xe2\x82\xac"),
            "k\xc3\xbc"
            "che \xe2\x82\xac");
  EXPECT_EQ(xmlEscaped("a\x01\n\x7f"
                       "b"),
            "a???b");
  EXPECT_EQ(xmlEscaped("bad \xff utf"), "bad \xef\xbf\xbd utf");
  EXPECT_EQ(xmlEscaped("\xef\xbf\xbf"), "\xef\xbf\xbd");
  EXPECT_EQ(xmlEscaped("]]>"), "]]&gt;");
}

TEST(JUnit, IsWrittenBesideTheOtherForms) {
  const ScratchFolder folder;
  const auto pack = folder.write("a&b.pack", "short");
  const auto report = folder.path() / "report.xml";
  EXPECT_EQ(check({.packs = {pack}, .junit = report}).exit_code,
            static_cast<int>(ErrorCode::kInvalidInput));
  EXPECT_THAT(test::fileContent(report),
              testing::AllOf(HasSubstr("a&amp;b.pack"), HasSubstr("tests=\"1\" failures=\"1\""),
                             HasSubstr("type=\"pack/truncated\"")));
  EXPECT_EQ(test::countEntries(folder.path()), 2U) << "nothing else is left";
}

TEST(JUnit, IsNotWrittenOverAPackNorIntoNowhere) {
  const ScratchFolder folder;
  const auto pack = folder.write("good.pack", goodBytes());
  const Outcome over = check({.packs = {pack}, .junit = pack});
  EXPECT_EQ(over.exit_code, static_cast<int>(ErrorCode::kInvalidInput));
  EXPECT_THAT(over.err, HasSubstr("is one of the packs; write to another file"));
  EXPECT_EQ(test::fileContent(pack), goodBytes());
  const Outcome nowhere = check({.packs = {pack}, .junit = folder.path() / "none/report.xml"});
  EXPECT_EQ(nowhere.exit_code, static_cast<int>(ErrorCode::kIo));
}

}  // namespace
}  // namespace galactic::pack_tool::check_test
