// Strings of JSON are UTF-8, whatever the bytes that they are made of.
#include "view/json_writer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace galactic::test::json_writer_test {
namespace {

/// The bits of `code` in so many bytes, as UTF-8 has them, also where that is against its rules.
std::string bytesOf(std::uint32_t code, int length) {
  constexpr std::uint32_t kLeads[] = {0, 0, 0xC0, 0xE0, 0xF0};
  std::string bytes(static_cast<std::size_t>(length), '\0');
  for (int n = length - 1; n > 0; --n) {
    bytes[static_cast<std::size_t>(n)] = static_cast<char>(0x80U | (code & 0x3FU));
    code >>= 6U;
  }
  bytes.front() = static_cast<char>(kLeads[length] | code);
  return bytes;
}

/// Whether RFC 3629 has the character, in so many bytes.
bool isCharacter(std::uint32_t code, int length) {
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  const int shortest = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
  return code <= 0x10FFFF && !is_surrogate && length == shortest;
}

TEST(JsonStrings, KeepCharactersAndReplaceTheBytesOfAllOthers) {
  std::size_t kept = 0;
  std::size_t replaced = 0;
  const auto check = [&](std::uint32_t code, int length) {
    const std::string bytes = bytesOf(code, length);
    const bool is_kept = isCharacter(code, length);
    ++(is_kept ? kept : replaced);
    const std::string inside = is_kept ? bytes : std::string(bytes.size(), '?');
    ASSERT_EQ(jsonString("a" + bytes + "b"), "\"a" + inside + "b\"") << code << " in " << length;
  };
  for (std::uint32_t code = 0; code < 0x800; ++code) check(code, 2);
  for (std::uint32_t code = 0; code < 0x10000; ++code) check(code, 3);
  for (std::uint32_t code = 0; code < 0x200000; code += 7) check(code, 4);
  EXPECT_GT(kept, replaced / 9);
  EXPECT_GT(replaced, kept / 9);
}

TEST(JsonStrings, ReplaceWhatIsCutOff) {
  EXPECT_EQ(jsonString("\xF0\x9F\x98\x80"), "\"\xF0\x9F\x98\x80\"");
  EXPECT_EQ(jsonString("\xF0\x9F\x98"), "\"???\"");
  EXPECT_EQ(jsonString("\xC3"), "\"?\"");
  EXPECT_EQ(jsonString("\xFF\n\"\\"), "\"?\\u000a\\\"\\\\\"");
}

}  // namespace
}  // namespace galactic::test::json_writer_test
