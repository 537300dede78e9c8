#include "outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "support/files/output_files.h"
#include "support/try.h"
#include "terminal.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// The files that the command and its jobs name. Other files that a bake reads are only known after
/// it.
ReadLog namedFiles(const BakeCommand& command, std::span<const PackJob> jobs) {
  ReadLog named;
  for (const fs::path& input : command.inputs) named.noteRead(input);
  named.noteRead(command.config);
  for (const PackJob& pack : jobs) {
    for (const fs::path& file : filesOf(pack.job)) named.noteRead(file);
  }
  return named;
}

/// Checks that the report is not one of the packs, under any name.
Result<void> checkReport(const fs::path& report, const OutputPacks& packs) {
  if (report.empty()) return {};
  const auto is_report = [&](const fs::path& pack) { return isSameFile(pack, report); };
  if (std::ranges::none_of(packs.named, is_report) &&
      std::ranges::none_of(packs.inside, is_report)) {
    return {};
  }
  return fail(ErrorCode::kInvalidInput, report.string(),
              "is also a pack that is written; give `report` another name");
}

Result<void> saveReport(const fs::path& path, const BuildOutcome& outcome, const Json& report) {
  if (path.empty()) return {};
  for (const PackOutcome& pack : outcome.packs) {
    RETURN_IF_ERROR(pack.log.checkNotRead(path));
  }
  return writeReport(path, report);
}

}  // namespace

Result<void> checkOutputs(const BakeCommand& command, std::span<const PackJob> jobs,
                          const OutputPacks& packs) {
  const ReadLog named = namedFiles(command, jobs);
  std::set<fs::path> outputs;
  RETURN_IF_ERROR(named.checkNotRead(command.run.report));
  RETURN_IF_ERROR(checkReport(command.run.report, packs));
  for (const fs::path& pack : packs.named) {
    RETURN_IF_ERROR(named.checkNotRead(pack));
    if (pack.extension() != ".pack") {
      return fail(ErrorCode::kInvalidInput, "out",
                  fmt::format("is \"{}\", expected NAME.pack, an existing folder or FOLDER/",
                              command.run.out.string()));
    }
    if (outputs.insert(pack.lexically_normal()).second) continue;
    return fail(ErrorCode::kInvalidInput, pack.string(),
                "would be written twice: two inputs have one name; use -o");
  }
  return {};
}

Result<void> tryReport(const BakeCommand& command) {
  return command.run.report.empty() ? Result<void>() : tryFile(command.run.report);
}

int endWith(const BakeCommand& command, const BuildOutcome& outcome, const Json& report,
            int exit_code) {
  const auto saved = saveReport(command.run.report, outcome, report);
  if (saved) return exit_code;
  const int code = refuse(saved.error());
  return exit_code == kExitOk ? code : exit_code;
}

int exitCodeOf(const BuildOutcome& outcome) {
  if (outcome.stopped) return kExitInterrupted;
  const Error* error = outcome.firstError();
  return error == nullptr ? kExitOk : static_cast<int>(error->code);
}

}  // namespace galactic::bake
