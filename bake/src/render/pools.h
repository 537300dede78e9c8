#pragma once
#include "galactic/bake/render_baker.h"
#include "render/lattice.h"

namespace galactic::bake {

/// What a model says beyond its clusters.
struct ModelFigures {
  std::uint32_t part = 0;
  std::uint32_t source_triangles = 0;
  float largest_error = 0;
  /// Whether a mesh of the pack has vertex colours: then all vertices get one.
  bool colored = false;
};

/// Appends a model to the pools of a pack, in their layout.
void appendModel(const LatticeModel& model, const ModelFigures& figures, BakedRenderMeshes& to);

}  // namespace galactic::bake
