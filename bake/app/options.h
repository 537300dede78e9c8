#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/scene_baker.h"
#include "galactic/error.h"

namespace galactic::bake {

/// How much to print.
enum class Verbosity { kQuiet, kNormal, kVerbose };

/// What the user typed, understood.
struct BakeCommand {
  std::vector<std::filesystem::path> inputs;
  /// A file for one input, a folder for several; empty: NAME.pack in the current folder.
  std::filesystem::path output;
  std::filesystem::path report;
  /// The file of options that was read, if any: like the inputs, nothing may replace it.
  std::filesystem::path config;
  MeshImportOptions import;
  SceneBakeOptions scene;
  bool dry_run = false;
  bool keep_going = false;
  Verbosity verbosity = Verbosity::kNormal;
  /// The options that decide the pack's content, as text, for its provenance.
  std::vector<std::pair<std::string, std::string>> content_options;
};

/// The command, or the exit code of a command line that needs no work: help, version, or a mistake,
/// which has been explained on stderr.
using ParsedCommand = std::variant<BakeCommand, int>;

[[nodiscard]] ParsedCommand parseCommandLine(int argc, const char* const* argv);

}  // namespace galactic::bake
