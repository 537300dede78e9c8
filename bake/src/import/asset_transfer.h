#pragma once
#include <cstddef>
#include <span>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"
#include "import/transfer_archive.h"

namespace galactic::bake {

template <class Archive>
void transferFields(Archive& archive, Is<SourceFile> auto& file) {
  archive(file.name, file.bytes, file.hash_low, file.hash_high);
}

template <class Archive>
void transferFields(Archive& archive, Is<ReadFiles> auto& read) {
  archive(read.files, read.absent, read.is_settled);
}

/// Writes a SourceAsset as bytes for another process of this same program: meshes one by one (so
/// that the sender can free each when it is sent), then the rest; or an error.
class AssetSender {
 public:
  explicit AssetSender(TransferSink sink) : sink_(std::move(sink)) {}

  void mesh(const SourceMesh& mesh) const;
  /// Everything but the meshes, and the end.
  void finish(const SourceAsset& asset) const;
  /// What went wrong, and the end; the meshes sent so far are forgotten.
  void fail(const Error& error) const;

 private:
  TransferSink sink_;
};

/// The asset that was sent, or the error that was sent. Fails with kInternal when the bytes are no
/// complete transfer; reads nothing beyond them.
[[nodiscard]] Result<SourceAsset> receiveAsset(std::span<const std::byte> bytes);

}  // namespace galactic::bake
