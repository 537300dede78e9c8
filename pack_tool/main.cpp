#include <cstdlib>
#include <exception>
#include <iostream>
#include <vector>

#include "pack_tool/command_line.h"
#include "support/console/prepare_program.h"
#include "support/console/standard_streams.h"
#include "support/exception_error.h"

namespace galactic::pack_tool {

namespace {

int runTool(int argc, const char* const* argv, const Console& console) {
  const auto verb = parseCommandLine(argc, argv, console);
  const int exit_code = verb ? (*verb)(console) : verb.error();
  return flushStandardOutput("galactic-pack", exit_code);
}

/// What is left to say that memory is lacking where all of it is taken.
std::vector<char>& memoryToEndWith() {
  static std::vector<char> kept(1 << 20);
  return kept;
}

/// Says what went wrong where nothing can be thrown: JSON allocates where it is freed, and so may
/// find that memory is lacking while an error of memory is on its way.
[[noreturn]] void endWithError() {
  std::vector<char>().swap(memoryToEndWith());
  std::_Exit(reportError(Console{std::cout, std::cerr}, errorOfException()));
}

}  // namespace

}  // namespace galactic::pack_tool

int main(int argc, char** argv) {
  galactic::prepareProgram();
  const galactic::pack_tool::Console console{std::cout, std::cerr};
  try {
    (void)galactic::pack_tool::memoryToEndWith();
    std::set_terminate(galactic::pack_tool::endWithError);
    return galactic::pack_tool::runTool(argc, argv, console);
  } catch (...) {
    return galactic::pack_tool::reportError(console, galactic::errorOfException());
  }
}
