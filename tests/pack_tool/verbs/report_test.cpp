// The HTML page about packs.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>

#include "pack_tool/asset_packs.h"
#include "pack_tool/verbs/verbs.h"
#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/pack_tool_fixture.h"
#include "support/packs/texture_pack_builder.h"
#include "support/packs/world_pack_builder.h"
#include "view/page_data.h"

namespace galactic::test::report_test {
namespace {

namespace fs = std::filesystem;
using pack_tool::ReportOptions;

const fs::path kGolden = test::sourceFolder() / "packs" / "golden";

struct Ran {
  int exit_code = 0;
  std::string err;
};

Ran run(const ReportOptions& options) {
  std::ostringstream out;
  std::ostringstream err;
  const int exit_code = pack_tool::runReport(options, {out, err});
  return {exit_code, err.str()};
}

std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(Report, ShowsEveryGridAndEverythingThatIsDrawn) {
  const ScratchFolder folder;
  const fs::path page = folder.path() / "page.html";
  const Ran ran =
      run({.packs = {kGolden / "room-column.pack", kGolden / "crate.pack", kGolden / "arm.pack"},
           .output = page});
  ASSERT_EQ(ran.exit_code, kExitOk) << ran.err;
  const std::string html = fileContent(page);
  EXPECT_EQ(countOf(html, "<section "), 3U);
  EXPECT_EQ(countOf(html, "free height, radius 0.12 m</figcaption>"), 1U);
  EXPECT_EQ(countOf(html, "as it is drawn</figcaption>"), 3U);
  // PNG files, as base64 begins with them.
  EXPECT_EQ(countOf(html, "base64,iVBORw0KGgo"), countOf(html, "<img "));
  EXPECT_EQ(countOf(html, "http"), 0U) << "the page must not need the network";
}

TEST(Report, ShowsGridsAsPicturesOfThemDo) {
  const ScratchFolder folder;
  const fs::path pack = kGolden / "room-column.pack";
  const fs::path page = folder.path() / "page.html";
  const fs::path picture = folder.path() / "plan.png";
  ASSERT_EQ(run({.packs = {pack}, .output = page}).exit_code, kExitOk);
  std::ostringstream out;
  std::ostringstream err;
  pack_tool::PictureOptions options{.pack = pack, .output = picture, .size = 360};
  options.grids.radius = 0.12F;
  ASSERT_EQ(pack_tool::runPicture(options, {out, err}), kExitOk) << err.str();
  EXPECT_EQ(countOf(fileContent(page), base64(fileContent(picture))), 1U);
}

TEST(Report, HasSeveralSheetsOfManyObjects) {
  const ScratchFolder folder;
  ToyObjects toys;
  toys.objects.assign(241, {});
  for (std::size_t n = 0; n < toys.objects.size(); ++n) {
    // Packs have them in order.
    toys.objects[n].name = "block " + std::to_string(1000 + n);
  }
  const fs::path pack = folder.write("many.pack", asText(buildPack(toys).bytes()));
  const fs::path page = folder.path() / "page.html";
  const Ran ran = run({.packs = {pack}, .output = page});
  ASSERT_EQ(ran.exit_code, kExitOk) << ran.err;
  const std::string html = fileContent(page);
  EXPECT_EQ(countOf(html, "as it is drawn, 1 to 240 of 241</figcaption>"), 1U);
  EXPECT_EQ(countOf(html, "as it is drawn, 241 to 241 of 241</figcaption>"), 1U);
}

TEST(Report, ShowsEpisodesOnTheirScenes) {
  const ScratchFolder folder;
  const fs::path world = writeWorld(folder, {});
  const fs::path page = folder.path() / "page.html";
  const Ran ran = run({.packs = {world}, .output = page});
  ASSERT_EQ(ran.exit_code, kExitOk) << ran.err;
  EXPECT_EQ(countOf(fileContent(page), "starts, targets and goals</figcaption>"), 1U);
}

TEST(Report, NamesPacksWithoutTheFoldersOfThisMachine) {
  const ScratchFolder folder;
  const fs::path pack = writePack(folder, "home/kitchen.pack", kitchenScene());
  const fs::path page = folder.path() / "page.html";
  const Ran ran = run({.packs = {pack, kGolden / "arm.pack"}, .output = page});
  ASSERT_EQ(ran.exit_code, kExitOk) << ran.err;
  const std::string html = fileContent(page);
  EXPECT_EQ(countOf(html, "<h2>kitchen.pack</h2>"), 1U);
  EXPECT_EQ(countOf(html, "<h2>arm.pack</h2>"), 1U);
  EXPECT_EQ(countOf(html, folder.path().string()), 0U);
  EXPECT_EQ(countOf(html, kGolden.string()), 0U);
}

TEST(Report, IsTheSameEachTime) {
  const ScratchFolder folder;
  for (const char* name : {"a.html", "b.html"}) {
    const Ran ran = run({.packs = {kGolden / "room-column.pack"}, .output = folder.path() / name});
    ASSERT_EQ(ran.exit_code, kExitOk) << ran.err;
  }
  EXPECT_EQ(fileContent(folder.path() / "a.html"), fileContent(folder.path() / "b.html"));
}

TEST(Report, EscapesWhatPacksSay) {
  const ScratchFolder folder;
  ScenePackFields fields = kitchenScene();
  fields.name = "<script>kitchen</script>";
  const fs::path pack = writePack(folder, "kitchen.pack", fields);
  const fs::path page = folder.path() / "page.html";
  const Ran ran = run({.packs = {pack}, .output = page});
  ASSERT_EQ(ran.exit_code, kExitOk) << ran.err;
  const std::string html = fileContent(page);
  EXPECT_EQ(countOf(html, "<script>"), 0U);
  EXPECT_GE(countOf(html, "&lt;script&gt;kitchen"), 1U);
}

TEST(Report, IsNotWrittenOverAPack) {
  const ScratchFolder folder;
  const fs::path pack = writePack(folder, "kitchen.html", kitchenScene());
  const std::string before = fileContent(pack);
  const Ran ran = run({.packs = {pack}, .output = pack});
  EXPECT_EQ(ran.exit_code, static_cast<int>(ErrorCode::kInvalidInput));
  EXPECT_EQ(fileContent(pack), before);
}

TEST(Report, IsNotWrittenOverATextureThatAWorldLists) {
  const ScratchFolder folder;
  WorldPackFields world = writePacks(folder, {});
  world.packs.push_back(writeListed(folder, "wood.html", buildPack(TexturePackFields{})));
  const fs::path pack = folder.write("world.pack", textOf(buildPack(world)));
  const fs::path texture = folder.path() / "wood.html";
  const std::string before = fileContent(texture);
  const Ran ran = run({.packs = {pack}, .output = texture});
  EXPECT_EQ(ran.exit_code, static_cast<int>(ErrorCode::kInvalidInput));
  EXPECT_NE(ran.err.find("wood.html: is also an input"), std::string::npos) << ran.err;
  EXPECT_EQ(fileContent(texture), before);
  EXPECT_EQ(run({.packs = {pack}, .output = folder.path() / "page.html"}).exit_code, kExitOk);
}

TEST(Report, CountsTheTexturesThatAWorldLists) {
  const ScratchFolder folder;
  WorldPackFields world = writePacks(folder, {});
  const std::size_t shown = world.packs.size() + 1;
  world.packs.push_back(writeListed(folder, "wood.pack", buildPack(TexturePackFields{})));
  const fs::path pack = folder.write("world.pack", textOf(buildPack(world)));
  const fs::path page = folder.path() / "page.html";
  // Twice, and yet the texture is one.
  ASSERT_EQ(run({.packs = {pack, pack}, .output = page}).exit_code, kExitOk);
  const std::string html = fileContent(page);
  EXPECT_EQ(countOf(html, "<p>" + std::to_string(2 * shown) + " packs, "), 1U);
  EXPECT_EQ(countOf(html, "MB, and 1 texture, 0.00 MB; "), 1U);
}

TEST(Report, OfAFileThatIsNoPackFailsAndLeavesNothing) {
  const ScratchFolder folder;
  const fs::path text = folder.write("text.pack", "no pack at all");
  const Ran ran = run({.packs = {text}, .output = folder.path() / "page.html"});
  EXPECT_EQ(ran.exit_code, static_cast<int>(ErrorCode::kInvalidInput));
  EXPECT_NE(ran.err.find("text.pack"), std::string::npos);
  EXPECT_EQ(countEntries(folder.path()), 1U);
}

}  // namespace
}  // namespace galactic::test::report_test
