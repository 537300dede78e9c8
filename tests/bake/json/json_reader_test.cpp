#include "json/json_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "support/scratch_folder.h"

namespace galactic::test::json_reader_test {
namespace {

std::string repeated(std::string_view text, std::size_t times) {
  std::string all;
  for (std::size_t n = 0; n < times; ++n) all += text;
  return all;
}

Result<bake::Json> read(const std::string& text) {
  const ScratchFolder folder;
  return bake::readJsonFile(folder.write("a.json", text),
                            {.what = "a test", .suffix = ".json", .max_bytes = 1U << 20U});
}

TEST(JsonFile, RefusesWhatLiesTooDeepInsideEachOther) {
  EXPECT_TRUE(read(repeated("[", 100) + repeated("]", 100)));
  EXPECT_TRUE(read(repeated(R"({"a":[)", 50) + repeated("]}", 50)));
  for (const std::string& text :
       {repeated("[", 101) + repeated("]", 101),
        repeated(R"({"a":)", 101) + "1" + repeated("}", 101), repeated("[", 400'000)}) {
    const auto deep = read(text);
    ASSERT_FALSE(deep);
    EXPECT_EQ(deep.error().code, ErrorCode::kInvalidInput);
    EXPECT_THAT(deep.error().message, testing::HasSubstr("more than 100 deep"));
  }
}

TEST(JsonFile, DoesNotCountWhatIsText) {
  EXPECT_TRUE(read(R"(["\"[[\\", ")" + repeated("[", 200) + R"("])"));
  EXPECT_TRUE(read("[" + repeated(R"(["]", "["], )", 200) + "1]"));
}

}  // namespace
}  // namespace galactic::test::json_reader_test
