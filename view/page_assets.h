#pragma once
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/pack.h"
#include "galactic/render_meshes.h"
#include "view/page_data.h"

namespace galactic {

/// A pack that a page shows. All of it must stay until the page is written.
struct PageAsset {
  const PackFile* pack = nullptr;
  /// With the textures that the pack shares; null where it has nothing to draw.
  std::shared_ptr<const RenderMeshes> meshes = nullptr;
  /// Of an episode pack, the numbers of those that are shown, ascending; empty for all.
  std::vector<std::uint32_t> episodes = {};
  /// What is known about the pack, as JSON: shown as a tree. Empty for nothing.
  std::string facts = {};
};

/// Writes packs into the data of a page, each as an object of JSON with its chunks.
/// page/src/data.js is the reader.
class AssetWriter {
 public:
  /// Textures larger than `texture_size` are written at the mip level of this edge.
  AssetWriter(JsonWriter& json, PageData& data, std::uint32_t texture_size)
      : json_(json), data_(data), texture_size_(texture_size) {}

  /// Fails with the errors of the readers of packs.
  [[nodiscard]] Result<void> write(const PageAsset& asset);
  /// The list of all textures, "textures": after the last asset.
  void writeTextures(std::string_view key);

 private:
  void writeMeshes(const PageAsset& asset);
  [[nodiscard]] Result<void> writeScene(const PackFile& pack);
  [[nodiscard]] Result<void> writeObjects(const PackFile& pack);
  [[nodiscard]] Result<void> writeRobot(const PackFile& pack);
  [[nodiscard]] Result<void> writeEpisodes(const PageAsset& asset);
  std::size_t textureNumber(const RenderTexture& texture);

  JsonWriter& json_;
  PageData& data_;
  std::uint32_t texture_size_;
  /// Numbers by texels, which several packs may share; and in the order of the numbers.
  std::map<std::string_view, std::size_t> number_of_texels_;
  std::vector<const RenderTexture*> textures_;
  /// Keeps the textures where they are.
  std::vector<std::shared_ptr<const RenderMeshes>> meshes_;
};

}  // namespace galactic
