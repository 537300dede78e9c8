#include <iostream>

#include "pack_tool/command_line.h"
#include "support/exception_error.h"
#include "support/standard_streams.h"

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

}  // namespace

}  // namespace galactic::pack_tool

int main(int argc, char** argv) {
  galactic::prepareStandardStreams();
  const galactic::pack_tool::Console console{std::cout, std::cerr};
  try {
    return galactic::pack_tool::runTool(argc, argv, console);
  } catch (...) {
    return galactic::pack_tool::reportError(console, galactic::errorOfException());
  }
}
