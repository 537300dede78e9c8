#pragma once
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "layout/render_mesh_builder.h"
#include "support/homes/small_home.h"
#include "support/packs/render_pack_parts.h"

namespace galactic::test {

/// An axis-aligned box, seen from outside or, with `inward`, from inside.
inline RenderSurface boxModel(const Block& box, std::uint16_t material, bool inward = false) {
  // Corner n is high along the axes whose bits are set.
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
      {{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3}, {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}}};
  RenderSurface surface;
  surface.material = material;
  for (std::uint32_t n = 0; n < 8; ++n) {
    surface.vertices.push_back(
        {.position = {(n & 1U) != 0 ? box.max.x : box.min.x, (n & 2U) != 0 ? box.max.y : box.min.y,
                      (n & 4U) != 0 ? box.max.z : box.min.z}});
  }
  for (const auto& [a, b, c, d] : kFaces) {
    if (inward) {
      surface.corners.insert(surface.corners.end(), {a, c, b, a, d, c});
    } else {
      surface.corners.insert(surface.corners.end(), {a, b, c, a, c, d});
    }
  }
  return surface;
}

/// Render meshes of these surfaces, one part each; material n has the n-th color (RGBA, R lowest).
inline RenderMeshesFields modelsOf(std::vector<std::pair<std::uint32_t, RenderSurface>> parts,
                                   const std::vector<std::uint32_t>& colors) {
  RenderMeshSource source;
  for (const std::uint32_t color : colors) source.materials.push_back({"paint", color});
  source.semantics = {"thing"};
  for (auto& [number, surface] : parts) {
    if (source.parts.empty() || source.parts.back().part != number) {
      source.parts.emplace_back().part = number;
    }
    source.parts.back().surfaces.push_back(std::move(surface));
  }
  Result<RenderMeshStorage> built = buildRenderMeshes(source);
  if (!built) throw std::runtime_error(built.error().text());
  return fieldsOf(*built);
}

// What is drawn in which color in the small home.
inline constexpr std::uint32_t kRoomColor = 0xFFD0D8E0;
inline constexpr std::uint32_t kTableColor = 0xFF305080;
inline constexpr std::uint32_t kBowlColor = 0xFF2020C0;
inline constexpr std::uint32_t kMugColor = 0xFF20A020;
inline constexpr std::uint32_t kBodyColor = 0xFF909090;
inline constexpr std::uint32_t kHandColor = 0xFFC0A000;

/// The small home with render meshes: the room and its table, the boxes of the objects, a box each
/// for the robot's base and hand.
inline WorldFields smallHomeWorldWithModels() {
  WorldFields world = smallHomeWorld();
  world.scene.render_meshes = modelsOf({{0, boxModel({{0, 0, 0}, {3, 2.5F, 3}}, 0, true)},
                                        {0, boxModel({{1, 0, 1}, {2, 0.7F, 2}}, 1)}},
                                       {kRoomColor, kTableColor});
  const Block box{{-0.05F, 0, -0.05F}, {0.05F, 0.1F, 0.05F}};
  world.objects.render_meshes =
      modelsOf({{0, boxModel(box, 0)}, {1, boxModel(box, 1)}}, {kBowlColor, kMugColor});
  world.robot.render_meshes =
      modelsOf({{0, boxModel({{-0.1F, -0.1F, -0.1F}, {0.1F, 0.2F, 0.1F}}, 0)},
                {4, boxModel({{-0.02F, -0.02F, -0.02F}, {0.06F, 0.02F, 0.02F}}, 1)}},
               {kBodyColor, kHandColor});
  return world;
}

}  // namespace galactic::test
