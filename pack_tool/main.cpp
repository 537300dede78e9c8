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

/// Picks the verb that belongs to a request.
struct Runner {
  const Console& console;

  int operator()(const InfoOptions& options) const { return runInfo(options, console); }
  int operator()(const CheckOptions& options) const { return runCheck(options, console); }
  int operator()(const ColumnOptions& options) const { return runColumn(options, console); }
  int operator()(const DiffOptions& options) const { return runDiff(options, console); }
  int operator()(const ExportOptions& options) const { return runExport(options, console); }
  int operator()(const PictureOptions& options) const { return runPicture(options, console); }
  int operator()(const ReportOptions& options) const { return runReport(options, console); }
  int operator()(const ViewOptions& options) const { return runView(options, console); }
};

int runTool(int argc, const char* const* argv, const Console& console) {
  const auto request = parseCommandLine(argc, argv, console);
  const int exit_code = request ? std::visit(Runner{console}, *request) : request.error();
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
