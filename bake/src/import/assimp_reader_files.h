#pragma once
#include <assimp/DefaultIOSystem.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "import/readable_gltf.h"
#include "import/source_files.h"

namespace galactic::bake {

/// The files that the reader asked for, in the order of its requests, without repetitions.
struct AskedFiles {
  std::vector<std::string> opened;
  std::vector<std::string> missing;
  /// Files that lie outside the asset's folder, and were therefore not looked for.
  std::vector<std::string> outside;
  FileSearch search;
};

/// Opens files for the reader and records which, because the reader does not report them. Opens
/// only regular files: opening a pipe would wait for its writer.
class RecordingFiles final : public Assimp::DefaultIOSystem {
 public:
  /// Opens nothing outside the folder of `main_input` unless `reach` allows it. The reader gets
  /// `readable`, if any, in place of `main_input`.
  RecordingFiles(AskedFiles& asked, const std::filesystem::path& main_input, Reach reach,
                 std::optional<ReadableGltf> readable);

  /// Overridden because the library's version opens the file to see whether it exists.
  bool Exists(const char* file) const override { return isPlainFile(file); }
  Assimp::IOStream* Open(const char* file, const char* mode) override;

 private:
  [[nodiscard]] bool isNear(const std::string& name) const;
  [[nodiscard]] bool isPlainFile(const std::string& name) const;
  [[nodiscard]] Assimp::IOStream* openPlain(const std::string& name, const char* mode);

  AskedFiles& asked_;
  std::string main_input_;
  /// Files below this folder may be opened; if empty, all files may.
  std::filesystem::path folder_;
  std::optional<ReadableGltf> readable_;
};

}  // namespace galactic::bake
