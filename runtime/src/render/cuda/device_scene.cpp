#include "render/cuda/device_scene.h"

#include <bit>
#include <span>
#include <utility>

#include "layout/render_texels.h"
#include "render/raster/tables.h"
#include "support/try.h"

namespace galactic::render::cuda {
namespace {

template <class T>
void pointTo(const T*& pointer, DeviceAddress address) {
  pointer = std::bit_cast<const T*>(address);
}

}  // namespace

template <class Values>
Result<DeviceAddress> DeviceScene::put(const Values& values) {
  const auto bytes = std::as_bytes(std::span(values));
  if (bytes.empty()) return DeviceAddress{0};
  Memory memory(*driver_, Memory::Kind::kDevice);
  RETURN_IF_ERROR(memory.reserve(bytes.size()));
  const DriverFunctions& functions = driver_->functions();
  RETURN_IF_ERROR(driver_->check(
      functions.copy_to_device(memory.address(), bytes.data(), bytes.size(), nullptr), "copy"));
  RETURN_IF_ERROR(driver_->check(functions.synchronize(nullptr), "copy"));
  memories_.push_back(std::move(memory));
  return memories_.back().address();
}

Result<PackTables> DeviceScene::putPack(const RenderMeshes& meshes,
                                        std::vector<DeviceAddress>& bases) {
  std::vector<std::uint32_t> texels;
  std::vector<SurfaceTexels> textures;
  // The textures of a pack that no earlier pack has share a base, up to this many texels.
  constexpr std::size_t kMostTexels = 0x7FFFFFFF;
  const auto close = [&]() -> Result<void> {
    ASSIGN_OR_RETURN(const DeviceAddress base, put(texels));
    bases.push_back(base);
    texels.clear();
    return {};
  };
  for (const RenderTexture& texture : meshes.textures) {
    const auto [known, is_new] = known_.try_emplace(keyOf(texture));
    if (is_new) {
      const std::vector<std::uint32_t> own = decodedTexels(texture);
      if (texels.size() + own.size() > kMostTexels) RETURN_IF_ERROR(close());
      known->second = {.texels = static_cast<std::uint32_t>(texels.size()),
                       .kind = textureKind(texture.size, bases.size())};
      texels.insert(texels.end(), own.begin(), own.end());
    }
    textures.push_back(known->second);
  }
  RETURN_IF_ERROR(close());
  PackTables tables;
  const auto move = [this](const auto& values, auto& pointer) -> Result<void> {
    ASSIGN_OR_RETURN(const DeviceAddress address, put(values));
    pointTo(pointer, address);
    return {};
  };
  RETURN_IF_ERROR(move(meshes.clusters, tables.clusters));
  RETURN_IF_ERROR(move(meshes.cluster_bounds, tables.cluster_bounds));
  RETURN_IF_ERROR(move(meshes.vertices, tables.vertices));
  RETURN_IF_ERROR(move(meshes.colors, tables.colors));
  RETURN_IF_ERROR(move(colorKinds(meshes), tables.color_kinds));
  RETURN_IF_ERROR(move(meshes.triangles, tables.triangles));
  RETURN_IF_ERROR(move(surfacesOf(meshes, textures), tables.surfaces));
  return tables;
}

Result<DeviceScene> DeviceScene::upload(const RenderLibrary& library, const Driver& driver) {
  DeviceScene scene(driver);
  std::vector<DeviceAddress> bases;
  std::vector<PackTables> packs;
  for (std::size_t p = 0; p < library.packs().size(); ++p) {
    ASSIGN_OR_RETURN(PackTables tables, scene.putPack(library.packs()[p], bases));
    tables.first_semantic = library.firstSemantic(p);
    packs.push_back(tables);
  }
  ASSIGN_OR_RETURN(const DeviceAddress first_pack, scene.put(packs));
  std::vector<ModelTables> models;
  for (std::uint32_t n = 0; n < library.modelCount(); ++n) {
    models.push_back(modelTables(library, n));
    pointTo(models.back().pack, first_pack + library.entry(n).pack * sizeof(PackTables));
    scene.cluster_counts_.push_back(models.back().cluster_count);
  }
  ASSIGN_OR_RETURN(scene.models_, scene.put(models));
  ASSIGN_OR_RETURN(scene.texel_bases_, scene.put(bases));
  return scene;
}

}  // namespace galactic::render::cuda
