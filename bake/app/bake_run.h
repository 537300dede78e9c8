#pragma once
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "galactic/bake/provenance.h"
#include "galactic/error.h"
#include "options.h"
#include "progress_line.h"

namespace galactic::bake {

using Json = nlohmann::ordered_json;

/// One input that could not be baked.
struct BakeFailure {
  std::filesystem::path input;
  Error error;
};

/// A file that a bake read.
struct ReadFile {
  std::filesystem::path path;
  /// What it held, where the reader said so.
  std::optional<SourceFile> content;
};

/// What all bakes of one command share: what was asked, what was read, and what became of it.
class BakeRun {
 public:
  explicit BakeRun(const BakeCommand& command) : command_(command), line_(command.saysMore()) {
    for (const std::filesystem::path& file : command.namedFiles()) noteRead(file);
  }

  [[nodiscard]] const BakeCommand& command() const { return command_; }
  [[nodiscard]] ProgressLine& line() { return line_; }

  /// Remembers files that were read: nothing is written over them.
  void noteRead(const std::filesystem::path& folder, const std::vector<SourceFile>& files);
  void noteRead(const std::filesystem::path& file) { read_.push_back({file, std::nullopt}); }
  [[nodiscard]] const std::vector<ReadFile>& filesRead() const { return read_; }
  /// Remembers a file that was looked for and is not there.
  void noteAbsent(const std::filesystem::path& file) { absent_.push_back(file); }
  [[nodiscard]] const std::vector<std::filesystem::path>& absentFiles() const { return absent_; }

  /// Refuses to write `output` over a file that the user owns and the bake reads.
  [[nodiscard]] Result<void> checkNotRead(const std::filesystem::path& output) const;

  /// Where the pack of `input` goes.
  [[nodiscard]] std::filesystem::path outputFor(const std::filesystem::path& input) const;

  /// Remembers a bake for the report.
  void succeed(Json entry) { baked_.push_back(std::move(entry)); }
  /// Explains an error on stderr and remembers it.
  void fail(const std::filesystem::path& input, const Error& error);
  /// Whether to begin the next input.
  [[nodiscard]] bool goesOn() const { return failures_.empty() || command_.keep_going; }

  [[nodiscard]] const std::vector<Json>& baked() const { return baked_; }
  [[nodiscard]] const std::vector<BakeFailure>& failures() const { return failures_; }
  /// That of the first error.
  [[nodiscard]] int exitCode() const {
    return failures_.empty() ? kExitOk : static_cast<int>(failures_.front().error.code);
  }

 private:
  const BakeCommand& command_;
  ProgressLine line_;
  std::vector<ReadFile> read_;
  std::vector<std::filesystem::path> absent_;
  std::vector<Json> baked_;
  std::vector<BakeFailure> failures_;
};

/// Provenance of a pack: the options of the command, the files read and the warnings.
[[nodiscard]] Provenance provenanceOf(const BakeCommand& command, std::vector<SourceFile> sources,
                                      std::vector<std::string> warnings);

/// The place of an error in `file`, from the place that a baker named, which knows no files.
[[nodiscard]] inline std::string inFile(const std::filesystem::path& file,
                                        const std::string& where) {
  return where.empty() ? file.string() : file.string() + ": " + where;
}

/// Seconds of wall clock since `start`.
[[nodiscard]] inline double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// One line on stderr: program, place, message.
void printError(const Error& error);

/// The same; the exit code.
[[nodiscard]] int refuse(const Error& error);

}  // namespace galactic::bake
