#include "import/content_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <utility>

#include "galactic/mapped_file.h"
#include "import/gltf_extensions.h"

namespace galactic::bake {
namespace {

std::string lowerCaseExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

Result<std::vector<std::string>> checkGltf(const std::filesystem::path& path,
                                           std::span<const std::byte> content) {
  GltfRequirements required = gltfRequirements(content);
  if (!required.unsupported) return std::move(required.warnings);
  return fail(ErrorCode::kUnsupported, path.string(),
              fmt::format("it requires the glTF extension {}, which is not supported; export it "
                          "without that extension (uncompressed)",
                          *required.unsupported));
}

Result<void> checkPly(const std::filesystem::path& path, std::span<const std::byte> content) {
  const std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
  constexpr std::string_view kMagic = "ply";
  const bool is_ply = text.size() >= kMagic.size() &&
                      std::equal(kMagic.begin(), kMagic.end(), text.begin(), [](char a, char b) {
                        return a == std::tolower(static_cast<unsigned char>(b));
                      });
  if (!is_ply) return {};  // the reader says so
  constexpr std::string_view kEnd = "end_header";
  // The first word of a line, and the line has an end.
  for (std::size_t at = text.find(kEnd); at != text.npos; at = text.find(kEnd, at + 1)) {
    const std::size_t next = at + kEnd.size();
    const bool starts_line = at > 0 && (text[at - 1] == '\n' || text[at - 1] == '\r');
    if (starts_line && next < text.size() && (text[next] == '\n' || text[next] == '\r')) return {};
  }
  return fail(ErrorCode::kInvalidInput, path.string(),
              "its PLY header has no end_header line; the file is cut off: export or download it "
              "again");
}

}  // namespace

Result<std::vector<std::string>> checkContent(const std::filesystem::path& path) {
  const std::string extension = lowerCaseExtension(path);
  const bool gltf = extension == ".glb" || extension == ".gltf";
  const bool ply = extension == ".ply";
  if (!gltf && !ply) return std::vector<std::string>();
  const auto file = MappedFile::open(path);
  if (!file) return tl::unexpected(file.error());
  if (gltf) return checkGltf(path, file->bytes());
  if (auto checked = checkPly(path, file->bytes()); !checked) {
    return tl::unexpected(std::move(checked.error()));
  }
  return std::vector<std::string>();
}

}  // namespace galactic::bake
