#include "run/run_files.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "drawing/picture_output.h"
#include "support/output_files.h"
#include "support/try.h"

namespace galactic {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFrames = "--frames";

/// A file that the run may write, and the option that asks for it.
struct Output {
  std::string_view option;
  fs::path file;
};

/// The packs of the world, those that it lists among them, and where the actions come from.
std::vector<fs::path> inputsOf(const World& world, const RunOptions& options) {
  std::vector<fs::path> inputs(options.packs.begin(), options.packs.end());
  for (const PackFile& pack : world.packs()) inputs.emplace_back(pack.where());
  if (!options.replayFile().empty()) inputs.emplace_back(options.replayFile());
  if (!options.policyFile().empty()) inputs.emplace_back(options.policyFile());
  return inputs;
}

/// The files that options name.
std::vector<Output> filesOf(const RunOptions& options) {
  const DrawingOptions& drawing = options.drawing;
  std::vector<Output> files;
  for (const Output& one : std::array{
           Output{"--record", options.record}, Output{"--report", options.report},
           Output{"--view", options.view}, Output{"--animation", options.animation},
           Output{"--contact-sheet", drawing.contact_sheet}, Output{"--video", drawing.video}}) {
    if (!one.file.empty()) files.push_back(one);
  }
  return files;
}

/// Of all frames those that could be another file of the run: by its name, or as a link to it.
std::vector<Output> doubtfulFrames(const fs::path& folder, const std::vector<fs::path>& inputs,
                                   const std::vector<Output>& files) {
  std::vector<Output> frames;
  const auto add = [&](const fs::path& file) {
    if (isFrameName(file.filename().string())) {
      frames.push_back({kFrames, folder / file.filename()});
    }
  };
  for (const fs::path& input : inputs) add(input);
  for (const Output& output : files) add(output.file);
  std::error_code none_yet;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none_yet)) {
    if (entry.is_symlink(none_yet)) add(entry.path());
  }
  return frames;
}

Result<void> checkOutputs(const std::vector<Output>& outputs, const std::vector<fs::path>& inputs) {
  for (auto one = outputs.begin(); one != outputs.end(); ++one) {
    for (const fs::path& input : inputs) RETURN_IF_ERROR(checkNotInput(one->file, input));
    for (auto other = outputs.begin(); other != one; ++other) {
      if (one->option == other->option || !isSameFile(one->file, other->file)) continue;
      return fail(ErrorCode::kInvalidInput, one->file.string(),
                  fmt::format("would be written twice: by {} and by {}; give each its own name",
                              other->option, one->option));
    }
  }
  return {};
}

}  // namespace

Result<void> tryOutputs(const World& world, const RunOptions& options) {
  const std::vector<fs::path> inputs = inputsOf(world, options);
  const std::vector<Output> files = filesOf(options);
  const fs::path frames = options.drawing.frames;
  std::vector<Output> outputs = files;
  if (!frames.empty()) {
    outputs.push_back({kFrames, frames});
    for (Output& frame : doubtfulFrames(frames, inputs, files)) outputs.push_back(std::move(frame));
  }
  RETURN_IF_ERROR(checkOutputs(outputs, inputs));
  // Other files may go into the folder of the frames.
  if (!frames.empty()) RETURN_IF_ERROR(makeFrameFolder(frames));
  for (const Output& output : files) RETURN_IF_ERROR(tryFile(output.file));
  return {};
}

}  // namespace galactic
