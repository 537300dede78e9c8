// What programs say of exceptions that nobody expects.
#include "support/exception_error.h"

#include <gtest/gtest.h>

#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

namespace galactic::test::exception_error_test {
namespace {

template <class Exception>
Error errorOf(const Exception& exception) {
  try {
    throw exception;
  } catch (...) {
    return errorOfException();
  }
}

void expectLackOfMemory(const Error& error) {
  EXPECT_EQ(error.code, ErrorCode::kUnsupported) << error.message;
  EXPECT_EQ(error.where, "available memory");
}

TEST(ErrorOfException, SaysThatMemoryIsLackingHoweverThatIsFound) {
  expectLackOfMemory(errorOf(std::bad_alloc()));
  expectLackOfMemory(errorOf(std::length_error("vector::reserve")));
  for (const std::errc why :
       {std::errc::resource_unavailable_try_again, std::errc::not_enough_memory}) {
    expectLackOfMemory(errorOf(std::system_error(std::make_error_code(why))));
  }
}

TEST(ErrorOfException, IsTheErrorThatWasThrown) {
  const ErrorException thrown({ErrorCode::kUnsupported, "render device", "is no more"});
  EXPECT_STREQ(thrown.what(), "render device: is no more");
  const Error error = errorOf(thrown);
  EXPECT_EQ(error.code, ErrorCode::kUnsupported);
  EXPECT_EQ(error.where, "render device");
  EXPECT_EQ(error.message, "is no more");
}

TEST(ErrorOfException, NamesWhatCannotBeReadOrWritten) {
  const auto full = std::make_error_code(std::errc::no_space_on_device);
  const Error printed = errorOf(std::system_error(full));
  EXPECT_EQ(printed.code, ErrorCode::kIo);
  EXPECT_EQ(printed.where, "standard output");
  const Error file = errorOf(std::filesystem::filesystem_error("cannot", "a.pack", full));
  EXPECT_EQ(file.code, ErrorCode::kIo);
  EXPECT_EQ(file.where, "a.pack");
  EXPECT_EQ(file.message, full.message());
}

TEST(ErrorOfException, CallsEverythingElseAFaultOfTheProgram) {
  for (const Error& error : {errorOf(std::logic_error("it")), errorOf(std::string("it"))}) {
    EXPECT_EQ(error.code, ErrorCode::kInternal);
    EXPECT_EQ(error.where, "internal error");
    EXPECT_TRUE(error.message.ends_with("; please report it")) << error.message;
  }
}

}  // namespace
}  // namespace galactic::test::exception_error_test
