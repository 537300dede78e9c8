#include "dataset/asset_merger.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <utility>

#include "galactic/bake/source_asset.h"
#include "import/affine.h"
#include "import/source_files.h"
#include "render/material_list.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// Beyond all materials: a mesh without one.
constexpr std::uint32_t kNoMaterial = std::numeric_limits<std::uint32_t>::max();

/// "*3" as "*(3 + first)"; what is no number stays and will not be found.
std::string shiftedEmbedded(const std::string& name, std::size_t first) {
  std::size_t index = 0;
  const char* end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + 1, end, index);
  if (error != std::errc() || stop != end) return name;
  return fmt::format("*{}", first + index);
}

}  // namespace

void AssetMerger::takeMaterials(const SourceAsset& asset, const fs::path& folder) {
  for (SourceMaterial material : asset.materials) {
    std::string& texture = material.base_color_texture;
    if (texture.starts_with('*')) {
      texture = shiftedEmbedded(texture, into_.textures.size());
    } else if (!texture.empty()) {
      texture = nameRelativeTo(main_input_, folder / texture);
    }
    into_.materials.push_back(std::move(material));
  }
  into_.textures.insert(into_.textures.end(), asset.textures.begin(), asset.textures.end());
}

std::uint32_t AssetMerger::take(const std::string& key, const SourceAsset& asset,
                                const fs::path& folder,
                                const std::optional<std::array<float, 4>>& color) {
  const auto first_mesh = static_cast<std::uint32_t>(into_.meshes.size());
  const std::string full_key = color ? fmt::format("{}\n{}", key, fmt::join(*color, " ")) : key;
  const auto [known, is_new] = first_meshes_.try_emplace(full_key, first_mesh);
  if (!is_new) return known->second;
  const auto first_material = static_cast<std::uint32_t>(into_.materials.size());
  takeMaterials(asset, folder);
  std::uint32_t plain = kNoMaterial;
  for (const SourceMesh& mesh : asset.meshes) {
    SourceMesh& taken = into_.meshes.emplace_back(mesh);
    if (color && !hasLooks(asset, mesh)) {
      if (plain == kNoMaterial) {
        plain = static_cast<std::uint32_t>(into_.materials.size());
        SourceMaterial& material = into_.materials.emplace_back();
        material.name = "URDF";
        material.base_color = *color;
        material.two_sided = true;
      }
      taken.material = plain;
    } else if (mesh.material < asset.materials.size()) {
      taken.material = first_material + mesh.material;
    } else {
      taken.material = kNoMaterial;
    }
  }
  return first_mesh;
}

void AssetMerger::place(std::uint32_t first_mesh, const SourceAsset& asset,
                        const Affine& world_from_asset, const std::string& name) {
  for (const SourceInstance& instance : asset.instances) {
    into_.instances.push_back(
        {.name = name,
         .mesh = first_mesh + instance.mesh,
         .world_from_mesh = compose(world_from_asset, instance.world_from_mesh)});
  }
}

void AssetMerger::noteFile(const fs::path& path, SourceFile file) {
  file.name = nameRelativeTo(main_input_, path);
  std::string name = file.name;
  files_.try_emplace(std::move(name), std::move(file));
}

Result<void> AssetMerger::noteFile(const fs::path& path) {
  if (files_.contains(nameRelativeTo(main_input_, path))) return {};
  ASSIGN_OR_RETURN(auto file, describeFile(path));
  noteFile(path, std::move(file));
  return {};
}

void AssetMerger::finish() {
  into_.read.files.clear();
  into_.read.files.reserve(files_.size());
  for (const auto& [name, file] : files_) into_.read.files.push_back(file);
}

}  // namespace galactic::bake
