// Pages as bytes: what goes in comes out, and nothing of a pack stands in the page as text.
#include "view/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <limits>
#include <string>
#include <vector>

#include "support/homes/small_home_models.h"

namespace galactic::test::page_test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string unpacked(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string packed;
  std::uint32_t bits = 0;
  unsigned count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6U | static_cast<std::uint32_t>(kDigits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    packed += static_cast<char>(bits >> count & 0xFFU);
  }
  std::string out(std::size_t{1} << 24U, '\0');
  auto size = static_cast<uLongf>(out.size());
  EXPECT_EQ(
      uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                 reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size())),
      Z_OK);
  out.resize(size);
  return out;
}

/// What stands in the n-th chunk of a page.
std::string chunkOf(const std::string& page, std::size_t number) {
  const std::string mark = "class=\"chunk\">";
  std::size_t at = 0;
  for (std::size_t n = 0; n <= number; ++n) at = page.find(mark, at) + mark.size();
  return unpacked(std::string_view(page).substr(at, page.find('<', at) - at));
}

std::size_t countOf(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos;
       at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

class Page : public testing::Test {
 protected:
  /// A page of a scene of this name.
  std::string pageOf(const std::string& name, const std::string& title = "kitchen") {
    ScenePackFields scene = smallHomeWorldWithModels().scene;
    scene.name = name;
    const AlignedBytes bytes = buildPack(scene);
    const auto pack = PackFile::view(bytes.bytes(), "folder/kitchen.pack");
    EXPECT_TRUE(pack) << pack.error().message;
    auto meshes = renderMeshesOf(*pack);
    const PageAsset asset{.pack = &*pack,
                          .meshes = std::make_shared<const RenderMeshes>(std::move(**meshes))};
    const auto page = viewPage({&asset, 1}, {}, {.title = title, .generator = "test"});
    EXPECT_TRUE(page);
    return page.value_or("");
  }
};

TEST(PackedText, UnpacksToTheSameBytesWhateverTheirLength) {
  for (std::size_t length = 0; length < 70; ++length) {
    std::string bytes;
    for (std::size_t n = 0; n < length; ++n) bytes += static_cast<char>(n * n * 37U);
    EXPECT_EQ(unpacked(packedText(bytes)), bytes);
  }
}

TEST(PackedText, IsSmallForWhatIsAlike) {
  EXPECT_LT(packedText(std::string(100'000, 'x')).size(), 1000U);
}

TEST(ChunkTest, PlanesHoldAllFirstBytesThenAllSecondOnes) {
  Chunk chunk;
  const std::vector<std::uint16_t> values{0x0102, 0x0304};
  chunk.addPlanes("values", std::span(values));
  EXPECT_EQ(chunk.bytes(), "\x02\x04\x01\x03");
}

TEST(ChunkTest, ArraysBeginWhereTypedArraysMay) {
  Chunk chunk;
  const std::vector<std::uint8_t> odd{1, 2, 3};
  const std::vector<float> floats{1.5F};
  chunk.add("odd", std::span(odd));
  chunk.add("floats", std::span(floats));
  EXPECT_EQ(chunk.arrays()[1].at % 8, 0U);
  EXPECT_EQ(chunk.bytes().size(), chunk.arrays()[1].at + sizeof(float));
}

TEST(JsonWriterTest, WritesNullForWhatIsNoNumber) {
  JsonWriter json;
  json.begin('{');
  json.number("a", std::numeric_limits<double>::quiet_NaN());
  json.numbers("b", std::span<const float>(std::array{0.1F, -1.0F / 0.0F}));
  json.end('}');
  EXPECT_EQ(json.take(), "{\n  \"a\": null,\n  \"b\": [0.1,null]\n}\n");
}

TEST(PageTemplate, HasOnePlaceForDataAndOneForTheTitle) {
  EXPECT_EQ(countOf(pageTemplate(), kDataMark), 1U);
  EXPECT_EQ(countOf(pageTemplate(), kTitleMark), 1U);
}

TEST(PageTemplate, NamesThePlacesOfNoNetwork) {
  // Browsers refuse what the policy does not name.
  EXPECT_THAT(std::string(pageTemplate()), HasSubstr("content=\"default-src 'none';"));
}

TEST(PageTemplate, HasTheLicenseOfWhatItContains) {
  EXPECT_THAT(std::string(pageTemplate()), HasSubstr("three.js authors"));
}

TEST_F(Page, HoldsTheSceneInItsFirstChunk) {
  EXPECT_THAT(chunkOf(pageOf("kitchen"), 0), HasSubstr("\"name\":\"kitchen\""));
}

TEST_F(Page, IsTheSameEachTime) { EXPECT_EQ(pageOf("kitchen"), pageOf("kitchen")); }

TEST_F(Page, TellsNoFolder) {
  const std::string page = pageOf("kitchen");
  EXPECT_THAT(chunkOf(page, 0), Not(HasSubstr("folder/")));
}

TEST_F(Page, NamesOfPacksAreNoMarkup) {
  const std::string name = "</script><b onclick=x>";
  const std::string page = pageOf(name);
  EXPECT_THAT(page, Not(HasSubstr("<b onclick")));
  EXPECT_THAT(chunkOf(page, 0), HasSubstr(name));
}

TEST_F(Page, TitlesAreNoMarkup) {
  const std::string page = pageOf("kitchen", "</title><b onclick=x>&amp;\n");
  EXPECT_THAT(page, HasSubstr("<title>?/title??b onclick=x??amp;?</title>"));
  EXPECT_THAT(page, Not(HasSubstr("<b onclick")));
}

TEST_F(Page, TitlesAreOfAnyScript) {
  EXPECT_THAT(pageOf("kitchen", "Küche, 台所"), HasSubstr("<title>Küche, 台所</title>"));
}

TEST_F(Page, NamesThatAreNoUtf8BecomeQuestionMarks) {
  EXPECT_THAT(chunkOf(pageOf("kitchen", "a\xff"), 0), HasSubstr("\"title\":\"a?\""));
}

}  // namespace
}  // namespace galactic::test::page_test
