#include "import/source_files.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "common/lfs_pointer.h"
#include "galactic/bake/source_asset.h"
#include "support/content_hash.h"
#include "support/files/mapped_file.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

std::optional<char> hexByte(char high, char low) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const int letter = std::tolower(static_cast<unsigned char>(c));
    return letter >= 'a' && letter <= 'f' ? letter - 'a' + 10 : -1;
  };
  if (digit(high) < 0 || digit(low) < 0) return std::nullopt;
  return static_cast<char>(digit(high) * 16 + digit(low));
}

std::string withForwardSlashes(std::string path) {
  std::replace(path.begin(), path.end(), '\\', '/');
  return path;
}

/// The file that `reference` means, if it exists.
std::optional<fs::path> findReference(const fs::path& folder, std::string reference, Reach reach,
                                      FileSearch& search) {
  constexpr std::string_view kFileScheme = "file://";
  if (reference.starts_with(kFileScheme)) reference.erase(0, kFileScheme.size());
  reference = withoutTrailingBlanks(reference);
  std::vector<std::string> spellings{reference, withoutUriEscapes(reference)};
  for (std::size_t i = 0; i < 2; ++i) spellings.push_back(withForwardSlashes(spellings[i]));
  for (const std::string& spelling : spellings) {
    const bool is_near = isBelow(folder / spelling, folder / "..");
    if (!is_near && reach == Reach::kNear) continue;
    if (search.findsFile(folder / spelling)) return folder / spelling;
  }
  const fs::path name = fs::path(spellings.back()).filename();
  // Gazebo's models have meshes/model.obj and materials/textures/texture.png.
  for (const fs::path& place : {folder, folder / ".." / "materials" / "textures"}) {
    if (search.findsFile(place / name)) return place / name;
  }
  return std::nullopt;
}

/// The image that belongs to a mesh by its name: named like the mesh or, as in Google Scanned
/// Objects, "texture"; beside the mesh, or where Gazebo's models have their textures.
std::optional<fs::path> namesakeOf(const fs::path& main_input, FileSearch& search) {
  const fs::path folder = main_input.parent_path();
  for (const fs::path& place : {folder, folder / ".." / "materials" / "textures"}) {
    for (const std::string& stem : {main_input.stem().string(), std::string("texture")}) {
      for (const char* extension : {".png", ".jpg", ".jpeg"}) {
        fs::path image = place / (stem + extension);
        if (search.findsFile(image)) return image;
      }
    }
  }
  return std::nullopt;
}

/// Number of different texture files that the materials name.
std::size_t namedTextures(const SourceAsset& asset) {
  std::set<std::string_view> names;
  for (const SourceMaterial& material : asset.materials) {
    const std::string& name = material.base_color_texture;
    if (!name.empty() && !name.starts_with('*')) names.insert(name);
  }
  return names.size();
}

void noteMissing(SourceAsset& asset, const std::string& sentence) {
  asset.missing.push_back(sentence);
  asset.warnings.push_back(sentence);
}

/// A substitute for the only texture, which is missing: the mesh's namesake. Adds a warning about
/// it.
std::optional<fs::path> substituteFor(const std::string& reference, SourceAsset& asset,
                                      const fs::path& main_input, FileSearch& search) {
  auto namesake = namesakeOf(main_input, search);
  if (!namesake) return std::nullopt;
  noteMissing(asset, fmt::format("texture '{}' is missing: '{}' is drawn instead", reference,
                                 nameRelativeTo(main_input, *namesake)));
  return namesake;
}

/// Gives an OBJ without MTL the mesh's namesake as its texture, if there is one; returns whether it
/// did. Meshes without texture coordinates stay as they are.
bool paintWithNamesake(SourceAsset& asset, const fs::path& main_input, FileSearch& search) {
  const bool is_obj = asset.format == "Wavefront OBJ";
  const bool has_coordinates =
      std::any_of(asset.meshes.begin(), asset.meshes.end(),
                  [](const SourceMesh& mesh) { return !mesh.uvs.empty(); });
  // Any MTL that was read, whatever its name, states the colors.
  const bool has_mtl = asset.read.files.size() > 1;
  if (!is_obj || has_mtl || !has_coordinates) return false;
  const auto namesake = namesakeOf(main_input, search);
  if (!namesake) return false;
  const std::string name = nameRelativeTo(main_input, *namesake);
  for (SourceMaterial& material : asset.materials) {
    material.base_color_texture = name;
    // The color that the reader sets if the file states none is not a factor.
    material.base_color = {1, 1, 1, material.base_color[3]};
  }
  asset.read.files.push_back({.name = name});
  if (asset.missing_materials.empty()) {
    asset.warnings.push_back(
        fmt::format("it has no MTL that names a texture: '{}' is drawn on all of it", name));
  } else {
    noteMissing(asset, fmt::format("its material file '{}' is missing: '{}' is drawn on all of it",
                                   asset.missing_materials.front(), name));
  }
  return true;
}

Result<void> hashFile(SourceFile& file, const fs::path& path) {
  ASSIGN_OR_RETURN(const auto content, MappedFile::open(path));
  file = describeBytes(std::move(file.name), content.bytes());
  return {};
}

}  // namespace

bool FileSearch::findsFile(const fs::path& file) {
  std::error_code unknown;
  const fs::file_status status = fs::status(file, unknown);
  if (status.type() == fs::file_type::not_found) absent_.push_back(file);
  return fs::is_regular_file(status);
}

bool FileSearch::findsFolder(const fs::path& folder) {
  std::error_code unknown;
  const fs::file_status status = fs::status(folder, unknown);
  if (status.type() == fs::file_type::not_found) absent_.push_back(folder);
  return fs::is_directory(status);
}

bool isLfsPointer(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string begin(kLfsSignature.size(), '\0');
  return stream.read(begin.data(), static_cast<std::streamsize>(begin.size())) &&
         begin == kLfsSignature;
}

std::string withoutUriEscapes(std::string_view uri) {
  std::string plain;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto byte =
        uri[i] == '%' && i + 2 < uri.size() ? hexByte(uri[i + 1], uri[i + 2]) : std::nullopt;
    plain += byte.value_or(uri[i]);
    if (byte) i += 2;
  }
  return plain;
}

std::string withoutTrailingBlanks(std::string_view text) {
  const std::size_t last = text.find_last_not_of(" \t\r\n\v\f");
  return std::string(text.substr(0, last == text.npos ? 0 : last + 1));
}

std::string nameRelativeTo(const fs::path& main_input, const fs::path& file) {
  std::error_code ignored;
  const fs::path folder = fs::absolute(main_input, ignored).lexically_normal().parent_path();
  return fs::absolute(file, ignored).lexically_normal().lexically_relative(folder).generic_string();
}

SourceFile describeBytes(std::string name, std::span<const std::byte> bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {.name = std::move(name),
          .bytes = bytes.size(),
          .hash_low = hash.low64,
          .hash_high = hash.high64};
}

std::string hexOf(const SourceFile& file) { return detail::hexOf({file.hash_low, file.hash_high}); }

Result<SourceFile> describeFile(const fs::path& path) {
  SourceFile file{.name = path.filename().generic_string()};
  RETURN_IF_ERROR(hashFile(file, path));
  return file;
}

bool isBelow(const fs::path& file, const fs::path& folder) {
  const auto plain = [](const fs::path& path) {
    std::error_code ignored;
    const fs::path absolute = fs::absolute(path, ignored).lexically_normal();
    return absolute.has_filename() ? absolute : absolute.parent_path();
  };
  const fs::path relative = plain(file).lexically_relative(plain(folder));
  return !relative.empty() && *relative.begin() != "..";
}

void findTextures(SourceAsset& asset, const fs::path& main_input, Reach reach) {
  const fs::path folder = main_input.parent_path();
  const bool only_one = namedTextures(asset) == 1;
  std::map<std::string, std::optional<fs::path>> found;
  FileSearch search;
  for (SourceMaterial& material : asset.materials) {
    const std::string reference = material.base_color_texture;
    if (reference.empty() || reference.starts_with('*')) continue;
    const auto [entry, is_new] = found.try_emplace(reference);
    if (is_new) entry->second = findReference(folder, reference, reach, search);
    if (!entry->second && is_new && only_one) {
      entry->second = substituteFor(reference, asset, main_input, search);
    }
    if (entry->second) {
      material.base_color_texture = nameRelativeTo(main_input, *entry->second);
      if (is_new) asset.read.files.push_back({.name = material.base_color_texture});
    } else {
      material.base_color_texture.clear();
      if (!is_new) continue;
      noteMissing(asset, fmt::format("texture '{}' of material '{}' is missing: its surfaces "
                                     "keep their plain color",
                                     reference, material.name));
    }
  }
  const bool is_painted = found.empty() && paintWithNamesake(asset, main_input, search);
  for (const std::string& file : asset.missing_materials) {
    if (is_painted) break;
    noteMissing(
        asset,
        fmt::format("material file '{}' is missing: its materials get default colors", file));
  }
  for (const fs::path& file : search.absent()) {
    asset.read.absent.push_back(nameRelativeTo(main_input, file));
  }
}

Result<void> hashFiles(std::vector<SourceFile>& files, const fs::path& main_input) {
  const std::string main_name = nameRelativeTo(main_input, main_input);
  const auto order = [&](const SourceFile& file) {
    return std::pair(file.name != main_name, std::string_view(file.name));
  };
  std::sort(files.begin(), files.end(),
            [&](const SourceFile& a, const SourceFile& b) { return order(a) < order(b); });
  const auto same = [](const SourceFile& a, const SourceFile& b) { return a.name == b.name; };
  files.erase(std::unique(files.begin(), files.end(), same), files.end());
  for (SourceFile& file : files) {
    if (auto hashed = hashFile(file, main_input.parent_path() / file.name); !hashed) return hashed;
  }
  return {};
}

}  // namespace galactic::bake
