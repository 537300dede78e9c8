#include "robot_description/named_files.h"

#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/lower_case.h"
#include "import/source_files.h"
#include "json/json_reader.h"
#include "robot_description/mesh_resolver.h"
#include "support/files/mapped_file.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// A glTF of more bytes has its buffers inside.
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

/// The values of all attributes called filename.
std::set<std::string> referencesIn(std::string_view urdf) {
  constexpr std::string_view kName = "filename";
  std::set<std::string> references;
  for (std::size_t at = urdf.find(kName); at != std::string_view::npos; at = urdf.find(kName, at)) {
    at += kName.size();
    const std::size_t open = urdf.find_first_not_of(" \t\r\n=", at);
    if (open == std::string_view::npos) break;
    if (urdf[open] != '"' && urdf[open] != '\'') continue;
    const std::size_t close = urdf.find(urdf[open], open + 1);
    if (close == std::string_view::npos) break;
    references.emplace(urdf.substr(open + 1, close - open - 1));
    at = close;
  }
  return references;
}

void addNamedByUrdf(const fs::path& urdf, const RobotImportOptions& options,
                    std::set<fs::path>& files) {
  if (sizeOf(urdf) > kMaxRobotFileBytes) return;
  const auto mapped = MappedFile::open(urdf);
  if (!mapped) return;
  const auto bytes = mapped->bytes();
  MeshResolver resolver(urdf, options);
  for (const std::string& reference :
       referencesIn({reinterpret_cast<const char*>(bytes.data()), bytes.size()})) {
    const fs::path mesh = resolver.resolve(reference).file;
    if (mesh.empty() || !files.insert(mesh).second) continue;
    if (lowerCase(mesh.extension().string()) == ".gltf") addNamedByGltf(mesh, files);
  }
}

}  // namespace

std::set<fs::path> namedFiles(const fs::path& input, const RobotImportOptions& options) {
  std::set<fs::path> files;
  const std::string extension = lowerCase(input.extension().string());
  if (extension == ".gltf") addNamedByGltf(input, files);
  if (extension == ".urdf") addNamedByUrdf(input, options, files);
  return files;
}

std::uint64_t bytesWithNamedFiles(const fs::path& input, const RobotImportOptions& options) {
  std::uint64_t bytes = sizeOf(input);
  for (const fs::path& file : namedFiles(input, options)) bytes += sizeOf(file);
  return bytes;
}

}  // namespace galactic::bake
