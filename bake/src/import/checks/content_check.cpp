#include "import/checks/content_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>
#include <utility>

#include "support/files/mapped_file.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

using Warnings = std::vector<std::string>;

std::string lowerCaseExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

Result<Warnings> checkGltf(const std::filesystem::path& path, std::span<const std::byte> content) {
  GltfRequirements required = gltfRequirements(content);
  if (required.is_too_deep) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                "its JSON nests objects and lists in more than 1000 levels, perhaps in `extras`; "
                "export it again without them");
  }
  if (required.unsupported) {
    return fail(ErrorCode::kUnsupported, path.string(),
                fmt::format("it requires the glTF extension {}, which is not supported; export it "
                            "without that extension (uncompressed)",
                            *required.unsupported));
  }
  if (auto checked = checkGltfRanges(path, content); !checked) {
    return tl::unexpected(std::move(checked.error()));
  }
  return std::move(required.warnings);
}

/// A format whose files state how much they hold, which no reader checks.
struct CountedFormat {
  std::string_view extension;
  Result<void> (*check)(std::string_view file, const std::string& where);
};

constexpr std::array kCountedFormats{
    CountedFormat{".ply", checkPlyCounts}, CountedFormat{".obj", checkObj},
    CountedFormat{".stl", checkStl}, CountedFormat{".off", checkOff}};

/// The readers of these formats refuse truncated files.
constexpr std::array<std::string_view, 3> kCheckedByReader{".dae", ".fbx", ".zae"};

}  // namespace

Result<Warnings> checkContent(const std::filesystem::path& path) {
  const std::string extension = lowerCaseExtension(path);
  const bool is_gltf = extension == ".glb" || extension == ".gltf";
  const auto counted =
      std::find_if(kCountedFormats.begin(), kCountedFormats.end(),
                   [&](const CountedFormat& format) { return format.extension == extension; });
  if (!is_gltf && counted == kCountedFormats.end()) {
    if (std::ranges::find(kCheckedByReader, extension) != kCheckedByReader.end()) return Warnings();
    return Warnings{fmt::format(
        "nothing tells whether a {} file is whole: should geometry lack, convert it to GLB",
        extension)};
  }
  ASSIGN_OR_RETURN(const auto file, MappedFile::open(path));
  if (is_gltf) return checkGltf(path, file.bytes());
  const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()),
                              file.bytes().size());
  if (auto checked = counted->check(text, path.string()); !checked) {
    return tl::unexpected(std::move(checked.error()));
  }
  return Warnings();
}

}  // namespace galactic::bake
