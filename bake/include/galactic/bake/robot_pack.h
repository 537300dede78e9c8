#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "galactic/bake/provenance.h"
#include "galactic/bake/robot_baker.h"
#include "galactic/error.h"

namespace galactic::bake {

/// The bytes of a robot pack's FlatBuffer, without the file header. The same robot and provenance
/// give the same bytes. Fails with kUnsupported when it would reach 2 GiB, the limit of one pack.
[[nodiscard]] Result<std::vector<std::byte>> encodeRobotPack(const BakedRobot& robot,
                                                             const Provenance& provenance);

/// Writes header and payload atomically; returns the file's size in bytes.
[[nodiscard]] Result<std::uint64_t> writeRobotPack(const std::filesystem::path& path,
                                                   const BakedRobot& robot,
                                                   const Provenance& provenance);

}  // namespace galactic::bake
