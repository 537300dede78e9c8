#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "galactic/bake/episode_set_import.h"
#include "support/scratch_folder.h"

namespace galactic::test::episode_list_test {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

Result<std::vector<std::uint32_t>> readList(std::string_view text) {
  const ScratchFolder folder;
  return bake::readEpisodeList(folder.write("good.txt", text));
}

TEST(EpisodeLists, HoldIndicesBlanksAndComments) {
  const auto list = readList("0\n 2\t3\r\n# a comment 9\n\n7 # not 8\n1");
  ASSERT_TRUE(list.has_value()) << list.error().message;
  EXPECT_THAT(*list, ElementsAre(0, 2, 3, 7, 1));
  const auto none = readList("");
  ASSERT_TRUE(none.has_value());
  EXPECT_THAT(*none, IsEmpty());
}

TEST(EpisodeLists, NameTheLineOfWhatIsNoIndex) {
  for (const char* word : {"-1", "x", "1.5", "4294967296", "3,4", "0x1"}) {
    SCOPED_TRACE(word);
    const auto list = readList("0\n1 " + std::string(word) + "\n2\n");
    ASSERT_FALSE(list.has_value());
    EXPECT_EQ(list.error().code, ErrorCode::kInvalidInput);
    EXPECT_THAT(list.error().where, EndsWith("good.txt:2"));
    EXPECT_THAT(list.error().message,
                HasSubstr("has \"" + std::string(word) + "\", expected indices"));
  }
}

TEST(EpisodeLists, ThatAreMissingAreAnIoError) {
  const auto list = bake::readEpisodeList("no/such/list.txt");
  ASSERT_FALSE(list.has_value());
  EXPECT_EQ(list.error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace galactic::test::episode_list_test
