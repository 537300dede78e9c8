#include "textures/texture_source.h"

#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <system_error>
#include <tuple>

#include "galactic/bake/source_asset.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// The number N in "*N"; none if the name has another form.
std::optional<std::size_t> embeddedIndex(std::string_view name) {
  std::size_t index = 0;
  const char* end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + 1, end, index);
  if (error != std::errc() || stop != end) return std::nullopt;
  return index;
}

void openEmbedded(TextureSource& source, std::string_view name,
                  std::span<const EmbeddedTexture> embedded) {
  const auto index = embeddedIndex(name);
  if (!index || *index >= embedded.size()) {
    source.fault = fmt::format("is missing: there are {} embedded images", embedded.size());
    return;
  }
  const EmbeddedTexture& image = embedded[*index];
  source.bytes = std::as_bytes(std::span(image.bytes));
  if (!image.bytes.empty()) return;
  source.fault = "is empty";
  constexpr std::string_view kNotEncoded = "raw";
  source.fault_is_known = image.format == kNotEncoded;
}

void openFile(TextureSource& source, const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    source.fault = "is missing";
    return;
  }
  if (!fs::is_regular_file(status)) {
    source.fault = "is not a file";
    return;
  }
  auto file = MappedFile::open(path);
  if (!file) {
    source.fault = fmt::format("cannot be read: {}", file.error().message);
    return;
  }
  source.file = std::move(*file);
  source.bytes = source.file->bytes();
}

/// `name` without this machine's folders.
std::string portableName(const std::string& name) {
  const fs::path path(name);
  return path.is_absolute() ? path.filename().generic_string() : path.generic_string();
}

/// Size and hash, which identify the content.
using Content = std::tuple<std::size_t, std::uint64_t, std::uint64_t>;

Content contentOf(std::span<const std::byte> bytes) {
  const SourceFile described = describeBytes({}, bytes);
  return {bytes.size(), described.hash_low, described.hash_high};
}

}  // namespace

TextureSources openTextures(std::span<const SourceMaterial> materials, const TextureFiles& files) {
  TextureSources opened;
  opened.of_material.reserve(materials.size());
  std::map<std::string, std::size_t> by_name;
  std::map<Content, std::size_t> by_content;
  for (const SourceMaterial& material : materials) {
    const std::string& name = material.base_color_texture;
    if (name.empty()) {
      opened.of_material.emplace_back();
      continue;
    }
    const auto [known, is_new] = by_name.try_emplace(name, opened.sources.size());
    if (is_new) {
      TextureSource source{.name = portableName(name),
                           .material = material.name,
                           .file = {},
                           .bytes = {},
                           .fault = {}};
      if (name.starts_with('*')) {
        openEmbedded(source, name, files.embedded);
      } else {
        openFile(source, files.folder / name);
      }
      const auto same = by_content.find(contentOf(source.bytes));
      if (source.fault.empty() && same != by_content.end()) {
        known->second = same->second;
      } else {
        if (source.fault.empty()) {
          by_content.emplace(contentOf(source.bytes), opened.sources.size());
        }
        opened.sources.push_back(std::move(source));
      }
    }
    opened.of_material.emplace_back(known->second);
  }
  return opened;
}

}  // namespace galactic::bake
