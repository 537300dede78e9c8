#pragma once
#include <assimp/DefaultIOSystem.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "import/readable_gltf.h"
#include "import/source_files.h"

namespace galactic::bake {

/// What the reader asked for, in this order, each once.
struct AskedFiles {
  std::vector<std::string> opened;
  std::vector<std::string> missing;
  /// Not looked for: they lie outside the asset's folder.
  std::vector<std::string> outside;
  FileSearch search;
};

/// Opens files for the reader and remembers which, because the reader does not tell. Nothing but
/// regular files: opening a pipe would wait for its writer.
class RecordingFiles final : public Assimp::DefaultIOSystem {
 public:
  /// Nothing is opened outside the folder of `main_input` that `reach` does not allow; `readable`
  /// is what the reader gets in place of `main_input`.
  RecordingFiles(AskedFiles& asked, const std::filesystem::path& main_input, Reach reach,
                 std::optional<ReadableGltf> readable);

  /// The library's own opens the file to see whether it is there.
  bool Exists(const char* file) const override { return isPlainFile(file); }
  Assimp::IOStream* Open(const char* file, const char* mode) override;

 private:
  [[nodiscard]] bool isNear(const std::string& name) const;
  [[nodiscard]] bool isPlainFile(const std::string& name) const;
  [[nodiscard]] Assimp::IOStream* openPlain(const std::string& name, const char* mode);

  AskedFiles& asked_;
  std::string main_input_;
  /// Empty: anything is near.
  std::filesystem::path folder_;
  std::optional<ReadableGltf> readable_;
};

}  // namespace galactic::bake
