#include "run/run_files.h"

#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "drawing/picture_output.h"
#include "support/files/output_files.h"
#include "support/try.h"

namespace galactic {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFrames = "--frames";

/// The packs of the world, including those that it lists, and the file that actions come from.
std::vector<fs::path> inputsOf(const World& world, const RunOptions& options) {
  std::vector<fs::path> inputs(options.packs.begin(), options.packs.end());
  for (const PackFile& pack : world.packs()) inputs.emplace_back(pack.where());
  if (!options.replayFile().empty()) inputs.emplace_back(options.replayFile());
  if (!options.policyFile().empty()) inputs.emplace_back(options.policyFile());
  return inputs;
}

/// The output files that options name.
std::vector<OutputFile> filesOf(const RunOptions& options) {
  const DrawingOptions& drawing = options.drawing;
  std::vector<OutputFile> files;
  for (const OutputFile& one :
       std::array{OutputFile{"--record", options.record}, OutputFile{"--report", options.report},
                  OutputFile{"--view", options.view}, OutputFile{"--animation", options.animation},
                  OutputFile{"--contact-sheet", drawing.contact_sheet},
                  OutputFile{"--video", drawing.video}}) {
    if (!one.file.empty()) files.push_back(one);
  }
  return files;
}

/// Checks that the extension of each output matches its kind of file.
Result<void> checkExtensions(const RunOptions& options) {
  const std::string& sheet = options.drawing.contact_sheet;
  if (!sheet.empty()) RETURN_IF_ERROR(checkExtension(sheet, kPictureFile));
  if (!options.view.empty()) RETURN_IF_ERROR(checkExtension(options.view, kPageFile));
  if (options.animation.empty()) return {};
  return checkExtension(options.animation, {".glb", "animations are binary glTF files"});
}

/// Of all frames, those that could be another file of the run: because of their name, or because
/// they are links.
std::vector<OutputFile> doubtfulFrames(const fs::path& folder, const std::vector<fs::path>& inputs,
                                       const std::vector<OutputFile>& files) {
  std::vector<OutputFile> frames;
  const auto add = [&](const fs::path& file) {
    if (isFrameName(file.filename().string())) {
      frames.push_back({kFrames, folder / file.filename()});
    }
  };
  for (const fs::path& input : inputs) add(input);
  for (const OutputFile& output : files) add(output.file);
  std::error_code none_yet;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none_yet)) {
    if (entry.is_symlink(none_yet)) add(entry.path());
  }
  return frames;
}

}  // namespace

Result<void> tryOutputs(const World& world, const RunOptions& options) {
  const std::vector<fs::path> inputs = inputsOf(world, options);
  const std::vector<OutputFile> files = filesOf(options);
  const fs::path frames = options.drawing.frames;
  std::vector<OutputFile> outputs = files;
  if (!frames.empty()) {
    outputs.push_back({kFrames, frames});
    for (OutputFile& frame : doubtfulFrames(frames, inputs, files))
      outputs.push_back(std::move(frame));
  }
  RETURN_IF_ERROR(checkOutputs(outputs, inputs));
  RETURN_IF_ERROR(checkExtensions(options));
  // After the checks, because other files may go into the folder of the frames.
  if (!frames.empty()) RETURN_IF_ERROR(makeFrameFolder(frames));
  for (const OutputFile& output : files) RETURN_IF_ERROR(tryFile(output.file));
  return {};
}

}  // namespace galactic
