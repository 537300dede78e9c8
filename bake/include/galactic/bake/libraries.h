#pragma once
#include <memory>

namespace galactic::bake {

class DatasetLibrary;
class FileDigests;
class TextureLibrary;
class TexturePacks;

/// What the bakes of one run share: what was read, decoded or checked for one pack serves all that
/// need it. A file is taken to stay as it was when it was first read, so the next run begins with
/// libraries of its own. Changes no byte of what is made. Thread-safe.
class BakeLibraries {
 public:
  BakeLibraries();
  ~BakeLibraries();
  BakeLibraries(const BakeLibraries&) = delete;
  BakeLibraries& operator=(const BakeLibraries&) = delete;

  /// Scene datasets, and the meshes that their scenes place.
  [[nodiscard]] DatasetLibrary& datasets();
  /// Images of scenes that share their textures.
  [[nodiscard]] TextureLibrary& images();
  /// The packs of these textures.
  [[nodiscard]] TexturePacks& texturePacks();
  /// What files hold.
  [[nodiscard]] FileDigests& digests();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace galactic::bake
