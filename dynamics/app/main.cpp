// galactic-dynamics: plays episodes of the simulation in a world where things have mass.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "command_line.h"
#include "comparisons.h"
#include "dynamics/episodes/episode_source.h"
#include "dynamics/report/journal.h"
#include "dynamics/report/moments.h"
#include "dynamics/report/report.h"
#include "dynamics/report/side_by_side.h"
#include "dynamics/sources/pack_sources.h"
#include "dynamics/sources/sources.h"
#include "galactic/bake/assets.h"
#include "galactic/bake/read_files.h"
#include "run/recording.h"
#include "support/console/prepare_program.h"
#include "support/console/standard_streams.h"
#include "support/console/stop_request.h"
#include "support/exception_error.h"
#include "support/files/atomic_file.h"
#include "support/files/output_files.h"
#include "support/text/printable.h"
#include "support/text/sentence_kinds.h"
#include "support/try.h"

namespace galactic::dynamics {
namespace {

/// Turns the option that the recipe's reader, being a library, names in backquotes into a flag.
std::string withFlags(std::string message) {
  constexpr std::string_view kName = "`data`";
  const std::size_t at = message.find(kName);
  if (at != std::string::npos) message.replace(at, kName.size(), "--data");
  return message;
}

int refuse(const Error& error) {
  printToStderr(fmt::format("galactic-dynamics: {}: {}\n", printable(error.where),
                            printable(withFlags(error.message))));
  return static_cast<int>(error.code);
}

/// The journal of finished episodes, beside the report.
std::filesystem::path journalFile(const Command& command) {
  return command.report.string() + ".partial";
}

/// Checks, before the work, that outputs can be written, and that they replace neither inputs,
/// including the packs that the world lists, nor each other.
Result<void> tryOutputs(const Command& command, const World& world, const bake::ReadLog& sources) {
  std::vector<std::filesystem::path> inputs(command.packs.begin(), command.packs.end());
  for (const PackFile& pack : world.packs()) inputs.emplace_back(pack.where());
  for (const bake::ReadFile& source : sources.files()) inputs.push_back(source.path);
  if (!command.recording.empty()) inputs.push_back(command.recording);
  if (!command.policyFile().empty()) inputs.push_back(command.policyFile());
  std::vector<OutputFile> outputs;
  if (!command.report.empty()) {
    outputs = {{"--report", command.report}, {"--report", journalFile(command)}};
  }
  if (!command.shown.view.empty()) outputs.push_back({"--view", command.shown.view});
  if (!command.shown.pictures.empty()) outputs.push_back({"--pictures", command.shown.pictures});
  RETURN_IF_ERROR(checkOutputs(outputs, inputs));
  const auto& [view, pictures] = command.shown;
  if (!view.empty()) RETURN_IF_ERROR(checkExtension(view, kPageFile));
  if (!pictures.empty()) RETURN_IF_ERROR(checkExtension(pictures, kPictureFile));
  for (const OutputFile& output : outputs) RETURN_IF_ERROR(tryFile(output.file));
  return {};
}

/// Records the content of the file at `path` under a name that does not depend on its folder.
Result<void> noteContent(const std::filesystem::path& path, std::string name, bake::ReadLog& read) {
  ASSIGN_OR_RETURN(auto file, bake::describeFile(path));
  file.name = std::move(name);
  read.note({}, {.files = {std::move(file)}});
  return {};
}

Result<std::unique_ptr<EpisodeSource>> openEpisodes(const Command& command, const World& world) {
  if (command.mode() == ComparisonMode::kReplay) {
    return recordedEpisodes(command.recording, world, command.episodes);
  }
  return playedEpisodes(command.policyFile(), command.loop, world, command.episodes);
}

/// The journal; none if no report is wanted. Its subject is everything that affects the
/// comparisons: the options, the content of the files that were read besides the packs, and this
/// program, since another build may play differently.
Result<std::optional<ComparisonJournal>> openJournal(const Command& command,
                                                     const EpisodeSource& episodes,
                                                     const World& world,
                                                     const ReportSubject& subject,
                                                     bake::ReadLog read) {
  if (command.report.empty()) return std::nullopt;
  RETURN_IF_ERROR(noteContent("/proc/self/exe", "galactic-dynamics", read));
  const std::filesystem::path played =
      command.mode() == ComparisonMode::kReplay ? command.recording : command.policyFile();
  if (!played.empty()) RETURN_IF_ERROR(noteContent(played, "played", read));
  std::string text = "galactic-dynamics " GALACTIC_VERSION " " + command.recipe.string();
  for (const OptionText& option : optionsOf(subject)) {
    text += fmt::format(" {}={}", option.name, option.value);
  }
  text += fmt::format(" {} episodes", episodes.count());
  for (const OptionText& option : listOptions(episodes.options())) {
    text += fmt::format(" {}={}", option.name, option.value);
  }
  for (const PackStamp& stamp : stampsOf(world)) {
    text += fmt::format(" {:016x}", stamp.payload_xxh64);
  }
  text += " " + digestOf(read);
  return ComparisonJournal::open(journalFile(command), text, world.robot().links().size());
}

Result<void> showBoth(const SideBySideParts& parts, const SideBySideFiles& files) {
  if (files.view.empty() && files.pictures.empty()) return {};
  ASSIGN_OR_RETURN(const auto notes, writeSideBySide(parts, files));
  // Printed even with --quiet: the user could take an older file for that of this run.
  for (const std::string& one : notes) {
    printToStderr(fmt::format("galactic-dynamics: {}\n", printable(one)));
  }
  return {};
}

/// Prints how to continue.
int endInterrupted(const Command& command, std::size_t done, std::size_t all) {
  const std::string advice = command.report.empty() ? "--report FILE.json would keep what is done"
                                                    : "start it again to go on from there";
  printToStderr(fmt::format("galactic-dynamics: interrupted after {} of {} episodes; {}\n", done,
                            all, advice));
  return kExitInterrupted;
}

/// Does the work; returns the exit code.
Result<int> run(const Command& command) {
  const StopRequest stop("galactic-dynamics");
  ASSIGN_OR_RETURN(const auto world, World::open(command.packs));
  ASSIGN_OR_RETURN(const auto sources,
                   readSources({.recipe = command.recipe, .data = command.data}, world));
  RETURN_IF_ERROR(tryOutputs(command, world, sources.log));
  ASSIGN_OR_RETURN(const auto episodes, openEpisodes(command, world));
  // The report lists all warnings.
  for (const std::string& warning : oneOfEachKind(sources.warnings, "--report lists them")) {
    if (command.is_quiet) break;
    printToStderr(fmt::format("galactic-dynamics: warning: {}\n", printable(warning)));
  }
  const std::filesystem::path played = command.mode() == ComparisonMode::kReplay
                                           ? command.recording
                                           : std::filesystem::path(command.policy);
  const ReportSubject subject{.mode = command.mode(),
                              .played = played.filename().string(),
                              .world = command.world,
                              .loop = command.loop,
                              .warnings = sources.warnings};
  ASSIGN_OR_RETURN(auto journal, openJournal(command, *episodes, world, subject, sources.log));
  const ComparisonWorlds worlds{world, episodes->options(), sources, command.world};
  Comparisons comparisons;
  ASSIGN_OR_RETURN(comparisons.episodes,
                   compareAll(*episodes, worlds, command, stop, journal ? &*journal : nullptr));
  if (comparisons.episodes.size() < episodes->count()) {
    return endInterrupted(command, comparisons.episodes.size(), episodes->count());
  }
  constexpr std::size_t kWorst = 10;
  comparisons.worst = worstMoments(comparisons.episodes, kWorst, command.mode());
  if (!command.is_quiet) fmt::print("{}", reportTable(comparisons, world, subject));
  RETURN_IF_ERROR(showBoth({comparisons, worlds, *episodes, subject}, command.shown));
  if (command.report.empty()) return kExitOk;
  RETURN_IF_ERROR(writeFileAtomically(command.report, reportJson(comparisons, world, subject)));
  journal->remove();
  return kExitOk;
}

int start(int argc, const char* const* argv) {
  Command command;
  if (const auto code = parseCommandLine(argc, argv, command)) return *code;
  const Result<int> done = run(command);
  return done ? *done : refuse(done.error());
}

}  // namespace
}  // namespace galactic::dynamics

int main(int argc, char** argv) {
  namespace dynamics = galactic::dynamics;
  galactic::prepareProgram();
  try {
    return galactic::flushStandardOutput("galactic-dynamics", dynamics::start(argc, argv));
  } catch (...) {
    return dynamics::refuse(galactic::errorOfException());
  }
}
