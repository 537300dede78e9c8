#include "render/material_list.h"

#include <span>

#include "support/try.h"

namespace galactic::bake {
namespace {

/// The color of meshes in files without materials.
constexpr std::array<float, 4> kNeutral{0.6F, 0.6F, 0.6F, 1.0F};

}  // namespace

bool hasLooks(const SourceAsset& asset, const SourceMesh& mesh) {
  if (!mesh.colors.empty()) return true;
  if (mesh.material >= asset.materials.size()) return false;
  const SourceMaterial& material = asset.materials[mesh.material];
  // Readers give this name to the material of files without materials.
  return !material.base_color_texture.empty() ||
         (!material.name.empty() && material.name != "DefaultMaterial");
}

std::uint32_t MaterialList::append(SourceMaterial material) {
  source_.materials.push_back(std::move(material));
  return static_cast<std::uint32_t>(source_.materials.size() - 1);
}

std::uint32_t MaterialList::add(const SourceAsset& asset, const SourceMesh& mesh) {
  if (mesh.material >= asset.materials.size()) return addColor(kNeutral, true);
  const SourceMaterial& material = asset.materials[mesh.material];
  const bool plain = mesh.uvs.empty() && !material.base_color_texture.empty();
  const auto [entry, fresh] = of_asset_.try_emplace({mesh.material, plain}, 0);
  if (fresh) {
    SourceMaterial copy = material;
    if (plain) copy.base_color_texture.clear();
    entry->second = append(std::move(copy));
  }
  return entry->second;
}

std::uint32_t MaterialList::addColor(const std::array<float, 4>& color, bool two_sided) {
  const auto [entry, fresh] = colors_.try_emplace({color, two_sided}, 0);
  if (fresh) {
    SourceMaterial material;
    material.name = "plain";
    material.base_color = color;
    material.two_sided = two_sided;
    entry->second = append(std::move(material));
  }
  return entry->second;
}

std::uint32_t MaterialList::addImage(const std::string& image, const std::array<float, 4>& tint,
                                     bool two_sided) {
  const auto [entry, fresh] = images_.try_emplace({image, tint, two_sided}, 0);
  if (fresh) {
    SourceMaterial material;
    material.name = image;
    material.base_color = tint;
    material.base_color_texture = image;
    material.two_sided = two_sided;
    entry->second = append(std::move(material));
  }
  return entry->second;
}

Result<void> MaterialList::bake(const TextureFiles& files, const TextureBakeOptions& options,
                                unsigned threads, TextureLibrary* library) {
  of_asset_.clear();
  const std::size_t first = source_.baked.materials.size();
  ASSIGN_OR_RETURN(auto baked, bakeMaterials(std::span(source_.materials).subspan(first), files,
                                             options, threads, library));
  galactic::bake::append(source_.baked, baked);
  return {};
}

}  // namespace galactic::bake
