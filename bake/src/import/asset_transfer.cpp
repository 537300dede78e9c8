#include "import/asset_transfer.h"

#include <utility>

namespace galactic::bake {
// One list of fields per type serves both directions: the archive is a writer or a reader.
template <class Archive>
void transferFields(Archive& archive, Is<SourceMesh> auto& mesh) {
  archive(mesh.name, mesh.positions, mesh.uvs, mesh.colors, mesh.triangles, mesh.material);
}

template <class Archive>
void transferFields(Archive& archive, Is<SourceInstance> auto& instance) {
  archive(instance.name, instance.mesh, instance.world_from_mesh);
}

template <class Archive>
void transferFields(Archive& archive, Is<SourceMaterial> auto& material) {
  archive(material.name, material.base_color, material.base_color_texture, material.two_sided,
          material.alpha_mode, material.alpha_cutoff);
}

template <class Archive>
void transferFields(Archive& archive, Is<EmbeddedTexture> auto& texture) {
  archive(texture.format, texture.bytes);
}

/// All fields of an asset except its meshes.
template <class Archive>
void transferRest(Archive& archive, auto& asset) {
  archive(asset.name, asset.format, asset.convention, asset.meters_per_unit, asset.unit_is_stated,
          asset.instances, asset.materials, asset.textures, asset.read, asset.missing_materials,
          asset.missing, asset.warnings);
}

namespace {

enum class Record : std::uint32_t { kMesh = 1, kRest = 2, kError = 3 };

}  // namespace

void AssetSender::mesh(const SourceMesh& mesh) const {
  TransferWriter writer(sink_);
  writer(Record::kMesh, mesh);
}

void AssetSender::finish(const SourceAsset& asset) const {
  TransferWriter writer(sink_);
  writer(Record::kRest);
  transferRest(writer, asset);
}

void AssetSender::fail(const Error& error) const {
  TransferWriter writer(sink_);
  writer(Record::kError, error);
}

Result<SourceAsset> receiveAsset(std::span<const std::byte> bytes) {
  TransferReader reader(bytes);
  SourceAsset asset;
  while (reader.good()) {
    Record record{};
    reader(record);
    if (!reader.good()) break;
    if (record == Record::kMesh) {
      reader(asset.meshes.emplace_back());
    } else if (record == Record::kRest) {
      transferRest(reader, asset);
      if (!reader.good() || !reader.atEnd()) break;
      return asset;
    } else if (record == Record::kError) {
      Error error;
      reader(error);
      if (!reader.good() || !reader.atEnd()) break;
      return tl::unexpected(std::move(error));
    } else {
      break;
    }
  }
  return fail(ErrorCode::kInternal, "mesh import",
              "the reading process delivered a broken asset; please report this with the file");
}

}  // namespace galactic::bake
