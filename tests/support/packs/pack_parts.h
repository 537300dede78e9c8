#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "galactic/pack_header.h"
#include "galactic/shapes.h"
#include "support/aligned_bytes.h"

namespace galactic::test {

// What the hand-made packs of objects and robots share. Everything is valid as it is declared; a
// test changes what it wants to be wrong. std::nullopt leaves a field out.

struct LengthFields {
  double mean = 0.001;
  double p95 = 0.002;
  double max = 0.004;
};

struct SphereStatisticsFields {
  float eps = 0.015F;
  float tau = 0.02F;
  std::optional<LengthFields> gap = LengthFields{};
  std::optional<LengthFields> protrusion = LengthFields{};
  double volume_ratio = 1.25;
  double guaranteed_gap = 0.015;
  double guaranteed_protrusion = 0.02;
};

/// A tetrahedron with a color for each corner.
struct SurfaceFields {
  std::vector<Vec3> positions{{0, 0, 0}, {0.1F, 0, 0}, {0, 0.1F, 0}, {0, 0, 0.1F}};
  std::vector<std::uint32_t> triangles{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  std::vector<std::uint32_t> colors{0xff0000ff, 0xff00ff00, 0xffff0000, 0xffffffff};
};

/// Puts the spheres of one set in the order that packs want.
void sortSpheres(std::span<SetSphere> spheres);

/// A pack's file with this payload and the header that belongs to it.
[[nodiscard]] AlignedBytes packFile(PackKind kind, std::span<const std::byte> payload);

}  // namespace galactic::test
