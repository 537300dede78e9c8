// Mapped files that are cut short end a program with a sentence.
#include "support/console/prepare_program.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "galactic/error.h"
#include "support/child_process.h"
#include "support/files/mapped_file.h"
#include "support/scratch_folder.h"

namespace galactic::test::prepare_program_test {
namespace {

constexpr std::size_t kBytes = 100'000;

int lastByteOf(const MappedFile& file) {
  const volatile std::byte* const last = &file.bytes().back();
  return std::to_integer<int>(*last);
}

/// Reads a file in `threads` after it was cut off.
int readCutFile(const std::filesystem::path& path, std::size_t threads) {
  const auto file = MappedFile::open(path);
  if (!file || lastByteOf(*file) != 'x') return 1;
  std::filesystem::resize_file(path, 10);
  std::vector<std::thread> readers;
  readers.reserve(threads);
  for (std::size_t n = 0; n < threads; ++n) readers.emplace_back([&] { (void)lastByteOf(*file); });
  for (std::thread& reader : readers) reader.join();
  return 0;
}

TEST(PreparedProgram, NamesTheMappedFileThatWasCutShort) {
  const ScratchFolder folder;
  for (const std::size_t threads : {1U, 4U}) {
    for (const char* name : {"a kitchen.pack", "a\nbath\tin\x1b.pack"}) {
      const auto path = folder.write(name, std::string(kBytes, 'x'));
      const ChildEnd end = inChild([&] {
        prepareProgram();
        return readCutFile(path, threads);
      });
      EXPECT_EQ(end.exit_code, static_cast<int>(ErrorCode::kIo)) << end.signal;
      const std::string shown = name[1] == ' ' ? "a kitchen.pack" : "a\\012bath?in?.pack";
      EXPECT_NE(end.err.find(": " + (std::filesystem::canonical(folder.path()) / shown).string() +
                             ": was cut short while it was in use, or its disk cannot"),
                std::string::npos)
          << end.err;
      EXPECT_EQ(end.err.find('\n'), end.err.size() - 1) << end.err;
    }
  }
}

TEST(PreparedProgram, EndsAsBeforeByWhatIsNoFile) {
  const ChildEnd sent = inChild([] {
    std::signal(SIGBUS, SIG_DFL);
    prepareProgram();
    (void)std::raise(SIGBUS);
    return 0;
  });
  EXPECT_EQ(sent.signal, SIGBUS) << sent.exit_code;
  EXPECT_EQ(sent.err, "");
}

}  // namespace
}  // namespace galactic::test::prepare_program_test
