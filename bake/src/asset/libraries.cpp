#include "galactic/bake/libraries.h"

#include "asset/texture_packs.h"
#include "cache/file_digests.h"
#include "dataset/dataset_library.h"
#include "galactic/bake/render_textures.h"

namespace galactic::bake {

struct BakeLibraries::State {
  DatasetLibrary datasets;
  TextureLibrary images;
  TexturePacks texture_packs;
  FileDigests digests;
};

BakeLibraries::BakeLibraries() : state_(std::make_unique<State>()) {}
BakeLibraries::~BakeLibraries() = default;

DatasetLibrary& BakeLibraries::datasets() { return state_->datasets; }
TextureLibrary& BakeLibraries::images() { return state_->images; }
TexturePacks& BakeLibraries::texturePacks() { return state_->texture_packs; }
FileDigests& BakeLibraries::digests() { return state_->digests; }

}  // namespace galactic::bake
