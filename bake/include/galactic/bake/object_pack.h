#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "galactic/bake/object_baker.h"
#include "galactic/bake/provenance.h"
#include "galactic/error.h"

namespace galactic::bake {

/// The objects of one pack, as they were baked.
struct BakedObjectSet {
  /// Working set, meters, ascending.
  std::vector<float> radii;
  std::vector<BakedObject> objects;
};

/// The bytes of an object pack's FlatBuffer, without the file header; objects by ascending name.
/// The same objects and provenance give the same bytes. Fails with kInvalidInput when there is
/// no object, one has no name or two have the same, and with kUnsupported when it would reach 2
/// GiB, the limit of one pack.
[[nodiscard]] Result<std::vector<std::byte>> encodeObjectPack(const BakedObjectSet& set,
                                                              const Provenance& provenance);

/// Writes header and payload atomically; returns the file's size in bytes.
[[nodiscard]] Result<std::uint64_t> writeObjectPack(const std::filesystem::path& path,
                                                    const BakedObjectSet& set,
                                                    const Provenance& provenance);

}  // namespace galactic::bake
