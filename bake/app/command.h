#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "galactic/bake/build.h"
#include "galactic/bake/job_lists.h"
#include "galactic/bake/jobs.h"
#include "galactic/error.h"

namespace galactic::bake {

/// How much to print.
enum class Verbosity { kQuiet, kNormal, kVerbose };

/// How the tool runs: what no pack's content depends on.
struct ToolOptions {
  Verbosity verbosity = Verbosity::kNormal;
  /// A file for one pack, a folder for several; empty: NAME.pack in the current folder.
  std::filesystem::path out{};
  /// Threads; 0 until the command line is read: one per processor.
  std::uint32_t threads = 0;
  std::filesystem::path report{};
  bool dry_run = false;
  bool keep_going = false;
};

/// How the many packs of a dataset or recipe are made.
struct ManyPacksOptions {
  /// Empty: beside the packs.
  std::filesystem::path cache{};
  bool no_cache = false;
  Shard shard{};
  /// Bytes that bakes, and scenes in which episodes are drawn, may take at the same time; 0: 3/4 of
  /// the machine's.
  std::uint64_t memory = 0;
};

void visitOptions(ToolOptions& options, OptionVisitor& visitor);
void visitOptions(ManyPacksOptions& options, OptionVisitor& visitor);

/// A dataset on the command line.
struct DatasetCommand {
  DatasetJobs jobs{};
  /// Only print the names of the scenes.
  bool list = false;
};

/// A recipe on the command line.
struct RecipeCommand {
  /// Where its files are looked for that are not beside it; empty: nowhere else.
  std::filesystem::path data{};
  EpisodeOverrides episodes{};
};

/// Those of them that a recipe may have, too.
void visitOptions(EpisodeOverrides& episodes, OptionVisitor& visitor);
void visitOptions(DatasetCommand& command, OptionVisitor& visitor);
void visitOptions(RecipeCommand& command, OptionVisitor& visitor);

/// What the user typed, understood.
struct BakeCommand {
  std::vector<std::filesystem::path> inputs;
  /// The file of options that was read, if any: like the inputs, nothing may replace it.
  std::filesystem::path config;
  /// Print a draft of a recipe for the robot, and bake nothing.
  bool prints_recipe = false;
  ToolOptions run;
  ManyPacksOptions many;
  /// The options of what is made of the inputs; its own inputs are empty.
  std::variant<Job, DatasetCommand, RecipeCommand> what;

  /// Whether it is a recipe or a dataset, of which many packs are made.
  [[nodiscard]] bool makesWorld() const { return !std::holds_alternative<Job>(what); }
  [[nodiscard]] bool saysMore() const { return run.verbosity >= Verbosity::kNormal; }
};

/// The command, or the exit code of a command line that needs no work: help, version, or a mistake,
/// which has been explained on stderr.
using ParsedCommand = std::variant<BakeCommand, int>;

[[nodiscard]] ParsedCommand parseCommandLine(int argc, const char* const* argv);

/// The command of these arguments, the program's name not among them. Fails with kInvalidInput, and
/// with kIo where the file of --config cannot be read.
[[nodiscard]] Result<BakeCommand> commandFrom(const std::vector<std::string>& arguments);

/// Whether it is an option of the command line that no recipe takes.
[[nodiscard]] bool isOfCommandLine(std::string_view name);

/// The packs that a command of a single kind makes of its files: one of each, or one of all. Fails
/// with kInvalidInput, kIo and kUnsupported on files of which no such pack can be made.
[[nodiscard]] Result<std::vector<PackJob>> packsOf(const BakeCommand& command);

/// What a command that makesWorld() makes of datasets or of a recipe. Fails as jobsOfDatasets and
/// jobsOfRecipe do.
[[nodiscard]] Result<WorldPlan> planOf(const BakeCommand& command, BakeLibraries& libraries);

}  // namespace galactic::bake
