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

/// Sends a SourceAsset, or an error, as bytes to another process of this same program: first the
/// meshes one by one, so that the sender can free each after sending it, then the rest.
class AssetSender {
 public:
  explicit AssetSender(TransferSink sink) : sink_(std::move(sink)) {}

  void mesh(const SourceMesh& mesh) const;
  /// Sends everything but the meshes, and ends the transfer.
  void finish(const SourceAsset& asset) const;
  /// Sends the error and ends the transfer; the receiver drops the meshes sent so far.
  void fail(const Error& error) const;

 private:
  TransferSink sink_;
};

/// Returns the asset that was sent, or the error that was sent. Fails with kInternal if the bytes
/// are not a complete transfer; never reads beyond them.
[[nodiscard]] Result<SourceAsset> receiveAsset(std::span<const std::byte> bytes);

}  // namespace galactic::bake
