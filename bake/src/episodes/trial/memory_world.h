#pragma once
#include <cstddef>
#include <memory>
#include <span>

#include "galactic/bake/episode_set_import.h"
#include "galactic/error.h"
#include "galactic/pack.h"
#include "galactic/world.h"

namespace galactic::bake {

/// A world of packs that are open and of episodes that are not in a file yet.
class MemoryWorld {
 public:
  /// `packs` are scenes, objects and the robot; they must outlive the result, and are not checked
  /// again. Fails with the errors of encodeEpisodePack and World::from.
  [[nodiscard]] static Result<MemoryWorld> open(std::span<const PackFile* const> packs,
                                                const SourceEpisodes& episodes);

  [[nodiscard]] const World& operator*() const { return world_; }

 private:
  class FileBytes;
  MemoryWorld(std::shared_ptr<const FileBytes> episodes, World world);

  /// The bytes that the world refers to.
  std::shared_ptr<const FileBytes> episodes_;
  World world_;
};

}  // namespace galactic::bake
