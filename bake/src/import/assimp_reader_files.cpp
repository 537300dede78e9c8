#include "import/assimp_reader_files.h"

#include <assimp/MemoryIOWrapper.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// `content` must outlive the stream. The caller closes the stream.
Assimp::IOStream* streamOf(const std::string& content) {
  return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(content.data()),
                                    content.size());
}

}  // namespace

RecordingFiles::RecordingFiles(AskedFiles& asked, const fs::path& main_input, Reach reach,
                               std::optional<ReadableGltf> readable)
    : asked_(asked), main_input_(main_input.string()), readable_(std::move(readable)) {
  if (reach == Reach::kNear) folder_ = fs::absolute(main_input).parent_path();
}

Assimp::IOStream* RecordingFiles::Open(const char* file, const char* mode) {
  if (readable_ && fs::path(file).filename() == kGltfFloatsFile) {
    return streamOf(readable_->floats);
  }
  // Readers pass names on as they stand in the file: "my%20scene.bin", "colors.mtl ".
  const std::string trimmed = withoutTrailingBlanks(file);
  std::vector<std::string> spellings{file};
  for (const std::string& other : {withoutUriEscapes(file), trimmed, withoutUriEscapes(trimmed)}) {
    if (std::ranges::find(spellings, other) == spellings.end()) spellings.push_back(other);
  }
  std::string name = trimmed;
  Assimp::IOStream* stream = nullptr;
  for (const std::string& spelling : spellings) {
    stream = openPlain(spelling, mode);
    if (stream == nullptr) continue;
    name = spelling;
    break;
  }
  const bool is_outside = stream == nullptr && !isNear(name);
  auto& list = is_outside ? asked_.outside : stream == nullptr ? asked_.missing : asked_.opened;
  if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  return stream;
}

bool RecordingFiles::isNear(const std::string& name) const {
  return folder_.empty() || isBelow(name, folder_);
}

bool RecordingFiles::isPlainFile(const std::string& name) const {
  return isNear(name) && asked_.search.findsFile(name);
}

Assimp::IOStream* RecordingFiles::openPlain(const std::string& name, const char* mode) {
  if (!isPlainFile(name)) return nullptr;
  if (readable_ && name == main_input_) return streamOf(readable_->file);
  return DefaultIOSystem::Open(name.c_str(), mode);
}

}  // namespace galactic::bake
