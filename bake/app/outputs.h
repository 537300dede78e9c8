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
  /// What `out` stands for: the world, or one of each input or of all.
  std::vector<std::filesystem::path> named;
  /// Those in a world's folder.
  std::vector<std::filesystem::path> inside{};
};

/// Two outputs must not be one file, none may replace an input of `jobs` or the options' file, and
/// a pack's name says that it is one. Fails with kInvalidInput.
[[nodiscard]] Result<void> checkOutputs(const BakeCommand& command, std::span<const PackJob> jobs,
                                        const OutputPacks& packs);

/// A bake may take hours: a report that cannot be written is found out before it. Fails with kIo.
[[nodiscard]] Result<void> tryReport(const BakeCommand& command);

/// Writes the report, where one is wanted and nothing that was read would be lost. The exit code of
/// the command, whose build ended with `exit_code`.
[[nodiscard]] int endWith(const BakeCommand& command, const BuildOutcome& outcome,
                          const Json& report, int exit_code);

/// That of the first error.
[[nodiscard]] int exitCodeOf(const BuildOutcome& outcome);

}  // namespace galactic::bake
