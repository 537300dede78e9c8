#pragma once
#include <filesystem>
#include <span>
#include <vector>

#include "command.h"
#include "galactic/bake/build.h"
#include "galactic/error.h"
#include "report.h"

namespace galactic::bake {

/// The packs that a command writes.
struct OutputPacks {
  /// What `out` names: the world, or one pack per input or one for all.
  std::vector<std::filesystem::path> named;
  /// The packs in a world's folder.
  std::vector<std::filesystem::path> inside{};
};

/// Checks that no two outputs are the same file, that none would overwrite an input of `jobs` or
/// the options file, and that packs are named *.pack. Fails with kInvalidInput.
[[nodiscard]] Result<void> checkOutputs(const BakeCommand& command, std::span<const PackJob> jobs,
                                        const OutputPacks& packs);

/// Checks that the report can be written, before a bake that may take hours. Fails with kIo.
[[nodiscard]] Result<void> tryReport(const BakeCommand& command);

/// Writes the report if one was requested and it would not overwrite a file that was read. Returns
/// the exit code of the command, whose build ended with `exit_code`.
[[nodiscard]] int endWith(const BakeCommand& command, const BuildOutcome& outcome,
                          const Json& report, int exit_code);

/// The exit code for the first error, kExitInterrupted for a stopped build, or kExitOk.
[[nodiscard]] int exitCodeOf(const BuildOutcome& outcome);

}  // namespace galactic::bake
