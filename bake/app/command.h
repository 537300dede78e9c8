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

/// How the tool runs. None of these options affects what a pack contains.
struct ToolOptions {
  Verbosity verbosity = Verbosity::kNormal;
  /// A file for one pack, a folder for several. Empty: NAME.pack in the current folder.
  std::filesystem::path out{};
  /// Number of threads. 0 until the command line has been read, which then sets one per processor.
  std::uint32_t threads = 0;
  std::filesystem::path report{};
  bool dry_run = false;
  bool keep_going = false;
};

/// How to make the packs of a dataset or recipe.
struct ManyPacksOptions {
  /// The cache's folder. Empty: beside the packs.
  std::filesystem::path cache{};
  bool no_cache = false;
  Shard shard{};
  /// Bytes of memory that concurrent bakes, and the scenes in which episodes are drawn, may use
  /// together. 0: 3/4 of the machine's memory.
  std::uint64_t memory = 0;
};

void visitOptions(ToolOptions& options, OptionVisitor& visitor);
void visitOptions(ManyPacksOptions& options, OptionVisitor& visitor);

/// A dataset on the command line.
struct DatasetCommand {
  DatasetJobs jobs{};
  /// Print only the names of the scenes.
  bool list = false;
};

/// A recipe on the command line.
struct RecipeCommand {
  /// The folder to search for files that are not beside the recipe. Empty: none.
  std::filesystem::path data{};
  EpisodeOverrides episodes{};
};

/// Visits the command-line options that a recipe may also set.
void visitOptions(EpisodeOverrides& episodes, OptionVisitor& visitor);
void visitOptions(DatasetCommand& command, OptionVisitor& visitor);
void visitOptions(RecipeCommand& command, OptionVisitor& visitor);

/// The parsed command line.
struct BakeCommand {
  std::vector<std::filesystem::path> inputs;
  /// The options file that was read, if any. Like an input, it must not be overwritten.
  std::filesystem::path config;
  /// Print a draft of a recipe for the robot, and bake nothing.
  bool prints_recipe = false;
  ToolOptions run;
  ManyPacksOptions many;
  /// What to make of the inputs, with its options. The inputs are in `inputs`, not in here.
  std::variant<Job, DatasetCommand, RecipeCommand> what;

  /// Whether the input is a recipe or a dataset, from which many packs are made.
  [[nodiscard]] bool makesWorld() const { return !std::holds_alternative<Job>(what); }
  [[nodiscard]] bool saysMore() const { return run.verbosity >= Verbosity::kNormal; }
};

/// The command, or an exit code if there is nothing left to do: help or the version was printed, or
/// a mistake was reported on stderr.
using ParsedCommand = std::variant<BakeCommand, int>;

[[nodiscard]] ParsedCommand parseCommandLine(int argc, const char* const* argv);

/// The command that `arguments` (without the program's name) stand for. Fails with kInvalidInput,
/// and with kIo if the file of --config cannot be read.
[[nodiscard]] Result<BakeCommand> commandFrom(const std::vector<std::string>& arguments);

/// Whether `name` is a command-line option that recipes do not accept.
[[nodiscard]] bool isOfCommandLine(std::string_view name);

/// The packs that a command for a single kind of pack makes from its files: one per file, or one
/// for all of them. Fails with kInvalidInput, kIo or kUnsupported on files that such a pack cannot
/// be made from.
[[nodiscard]] Result<std::vector<PackJob>> packsOf(const BakeCommand& command);

/// What a command with makesWorld() makes of its datasets or recipe. Fails like jobsOfDatasets and
/// jobsOfRecipe.
[[nodiscard]] Result<WorldPlan> planOf(const BakeCommand& command, BakeLibraries& libraries);

}  // namespace galactic::bake
