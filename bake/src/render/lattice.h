#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/part_mesh.h"
#include "render/piece.h"

namespace galactic::bake {

/// A corner on the lattice of its model.
struct LatticeVertex {
  std::array<std::int32_t, 3> at{};
  std::array<float, 2> uv{};
  std::uint32_t color = 0xFFFFFFFF;
};
static_assert(sizeof(LatticeVertex) == 24, "compared byte by byte, so without padding");

/// What is drawn or left out together.
struct LatticeCluster {
  std::vector<LatticeVertex> vertices;
  std::vector<std::array<std::uint8_t, 3>> triangles;
  SurfaceKey surface;
  bool two_sided = false;
};

/// A model on its lattice.
struct LatticeModel {
  /// Metres: a power of two.
  double step = 0;
  /// In spatial order.
  std::vector<LatticeCluster> clusters;
};

/// Puts finished pieces on the finest lattice, but not finer than kFinestStep, on which every
/// cluster spans at most 65,535 steps, and cuts them into clusters. Corners at one position come to
/// one lattice point; triangles that lose their area there are dropped.
[[nodiscard]] LatticeModel cutModel(std::span<const FinishedPiece> pieces,
                                    const RenderSource& source, unsigned jobs);

}  // namespace galactic::bake
