#pragma once
#include <memory>

namespace galactic::bake {

class DatasetLibrary;
class FileDigests;
class TextureLibrary;
class TexturePacks;

/// What the bakes of one run share: whatever was read, decoded or checked for one pack is reused
/// for all packs that need it. Files are assumed not to change after they were first read, so each
/// run needs libraries of its own. The libraries do not affect the bytes of packs. Thread-safe.
class BakeLibraries {
 public:
  BakeLibraries();
  ~BakeLibraries();
  BakeLibraries(const BakeLibraries&) = delete;
  BakeLibraries& operator=(const BakeLibraries&) = delete;

  /// Scene datasets, and the meshes that their scenes place.
  [[nodiscard]] DatasetLibrary& datasets();
  /// Images of scenes that share textures.
  [[nodiscard]] TextureLibrary& images();
  /// The packs of these textures.
  [[nodiscard]] TexturePacks& texturePacks();
  /// Hashes of files' contents.
  [[nodiscard]] FileDigests& digests();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace galactic::bake
