#include "robot_description/named_files.h"

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "common/lower_case.h"
#include "import/source_files.h"
#include "json/json_reader.h"
#include "robot_description/mesh_resolver.h"
#include "support/files/mapped_file.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// A larger glTF has its buffers inside.
constexpr std::size_t kMostGltfBytes = std::size_t{16} << 20U;

std::uint64_t sizeOf(const fs::path& file) {
  std::error_code problem;
  const std::uintmax_t bytes = fs::file_size(file, problem);
  return problem ? 0 : bytes;
}

void addNamedByGltf(const fs::path& gltf, std::set<fs::path>& files) {
  const auto json =
      readJsonFile(gltf, {.what = "a glTF", .suffix = ".gltf", .max_bytes = kMostGltfBytes});
  if (!json || !json->is_object()) return;
  for (const char* list : {"buffers", "images"}) {
    const auto entries = json->find(list);
    if (entries == json->end() || !entries->is_array()) continue;
    for (const Json& entry : *entries) {
      const auto uri = entry.is_object() ? entry.find("uri") : entry.end();
      if (uri == entry.end() || !uri->is_string()) continue;
      const auto& text = uri->get_ref<const std::string&>();
      if (text.starts_with("data:")) continue;
      fs::path file = (gltf.parent_path() / withoutUriEscapes(text)).lexically_normal();
      if (sizeOf(file) > 0) files.insert(std::move(file));
    }
  }
}

/// The values of all attributes with these names, in the order of the text.
std::vector<std::string> valuesOf(std::string_view text,
                                  std::initializer_list<std::string_view> names) {
  std::vector<std::string> values;
  constexpr std::string_view kBlanks = " \t\r\n";
  for (std::size_t at = text.find('='); at != std::string_view::npos; at = text.find('=', at + 1)) {
    const std::size_t open = text.find_first_not_of(kBlanks, at + 1);
    if (open == std::string_view::npos) break;
    if (text[open] != '"' && text[open] != '\'') continue;
    const std::size_t close = text.find(text[open], open + 1);
    if (close == std::string_view::npos) break;
    std::string_view name = text.substr(0, at);
    name = name.substr(0, name.find_last_not_of(kBlanks) + 1);
    const std::size_t before = name.find_last_of(kBlanks);
    if (before != std::string_view::npos) name.remove_prefix(before + 1);
    if (std::ranges::find(names, name) != names.end()) {
      values.emplace_back(text.substr(open + 1, close - open - 1));
    }
    at = close;
  }
  return values;
}

bool isMjcf(const fs::path& path) {
  const std::string extension = lowerCase(path.extension().string());
  return extension == ".xml" || extension == ".mjcf";
}

/// Collects the files that a robot's file names.
class RobotSearch {
 public:
  RobotSearch(const fs::path& path, const RobotImportOptions& options, std::set<fs::path>& files)
      : resolver_(path, options), files_(files) {}

  void addNamedBy(const fs::path& robot) {
    if (sizeOf(robot) > kMaxRobotFileBytes) return;
    const auto mapped = MappedFile::open(robot);
    if (!mapped) return;
    const auto bytes = mapped->bytes();
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    // Folders of an MJCF's meshes and textures.
    std::vector<std::string> folders{""};
    for (std::string& folder : valuesOf(text, {"meshdir", "assetdir", "texturedir"})) {
      folders.push_back(std::move(folder));
    }
    for (const std::string& reference : valuesOf(text, {"filename", "file"})) {
      for (const std::string& folder : folders) {
        if (add(folder.empty() ? reference : (fs::path(folder) / reference).string())) break;
      }
    }
  }

 private:
  /// Adds the file; returns whether it exists.
  bool add(const std::string& reference) {
    const fs::path file = resolver_.resolve(reference).file;
    if (file.empty()) return false;
    if (!files_.insert(file).second) return true;
    if (lowerCase(file.extension().string()) == ".gltf") addNamedByGltf(file, files_);
    if (isMjcf(file)) addNamedBy(file);
    return true;
  }

  MeshResolver resolver_;
  std::set<fs::path>& files_;
};

}  // namespace

std::set<fs::path> namedFiles(const fs::path& input, const RobotImportOptions& options) {
  std::set<fs::path> files;
  const std::string extension = lowerCase(input.extension().string());
  if (extension == ".gltf") addNamedByGltf(input, files);
  if (extension == ".urdf" || isMjcf(input)) RobotSearch(input, options, files).addNamedBy(input);
  return files;
}

std::uint64_t bytesWithNamedFiles(const fs::path& input, const RobotImportOptions& options) {
  std::uint64_t bytes = sizeOf(input);
  for (const fs::path& file : namedFiles(input, options)) bytes += sizeOf(file);
  return bytes;
}

}  // namespace galactic::bake
