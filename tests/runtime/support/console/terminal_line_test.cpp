// Lines that are written over fit on the terminal.
#include "support/console/terminal_line.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <string>

namespace galactic::test::terminal_line_test {
namespace {

/// A terminal that nobody looks at.
class Terminal {
 public:
  explicit Terminal(unsigned short columns) : file_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    const winsize size{.ws_row = 24, .ws_col = columns, .ws_xpixel = 0, .ws_ypixel = 0};
    EXPECT_EQ(::ioctl(file_, TIOCSWINSZ, &size), 0);
  }
  ~Terminal() { ::close(file_); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  Terminal(Terminal&&) = delete;
  Terminal& operator=(Terminal&&) = delete;

  [[nodiscard]] int file() const { return file_; }

 private:
  int file_;
};

TEST(AFittingLine, LeavesTheLastColumnFree) {
  const Terminal narrow(20);
  EXPECT_EQ(fittingLine(std::string(30, 'x'), narrow.file()), std::string(19, 'x'));
  EXPECT_EQ(fittingLine("step 3 of 10", narrow.file()), "step 3 of 10");
  EXPECT_EQ(fittingLine("", narrow.file()), "");
}

TEST(AFittingLine, CutsBetweenLetters) {
  EXPECT_EQ(fittingLine("Küchentür", Terminal(3).file()), "Kü");
  EXPECT_EQ(fittingLine("Küchentür", Terminal(2).file()), "K");
  EXPECT_EQ(fittingLine("Küchentür", Terminal(9).file()), "Küchentü");
  EXPECT_EQ(fittingLine("Küchentür", Terminal(10).file()), "Küchentür");
}

TEST(AFittingLine, IsWholeWhereTheWidthIsNotKnown) {
  const std::string line(300, 'x');
  EXPECT_EQ(fittingLine(line, Terminal(0).file()), line);
  EXPECT_EQ(fittingLine(line, -1), line);
}

}  // namespace
}  // namespace galactic::test::terminal_line_test
