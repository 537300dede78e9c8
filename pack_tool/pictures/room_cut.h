#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "layout/render_mesh_builder.h"

namespace galactic::pictures {

/// What of a scene is left out so that one can look into its rooms: heights of the world, meters.
struct RoomCut {
  /// Everything above; what reaches from below to above is cut through.
  float height = 0;
  /// Triangles that are about level and lie wholly above this: ceilings of lower rooms.
  float level = 0;
};

/// The cut of a floor plan: 1.2 m above the floor, where it goes through walls, doors and most
/// windows and over tables; lower where there is less above the floor. The floor is the lowest
/// level that has about as much area as the largest one, or the lowest point of a scene without
/// floors. `surfaces`: a scene in its world, at least one vertex.
[[nodiscard]] RoomCut floorPlanCut(std::span<const RenderSurface> surfaces);

/// A piece of a line where a cut goes through a surface, meters. What goes towards higher z has the
/// outer side of the surface at higher x.
struct SectionLine {
  float from_x = 0;
  float from_z = 0;
  float to_x = 0;
  float to_z = 0;
};

/// Cuts a surface whose vertices are in the world, and appends to `section` where it was cut
/// through: pieces that do not hang together, in the order of the triangles.
void cutThrough(const RoomCut& cut, RenderSurface& surface, std::vector<SectionLine>& section);

/// A rectangle of the ground plane, meters.
struct SectionRect {
  float low_x = 0;
  float low_z = 0;
  float high_x = 0;
  float high_z = 0;
};

/// What lies inside of walls, furniture and other solids that a section shows, in rectangles as
/// thick as a cell of `cell` meters; nothing where that would be more than 2^24 cells. Inside is
/// what at least three of the four directions of the axes find enclosed by outer sides: surfaces
/// may have gaps and loose sheets between them. What is more than a meter wide in all directions is
/// taken for a room whose walls are sheets, and left out.
[[nodiscard]] std::vector<SectionRect> filledSection(std::span<const SectionLine> section,
                                                     double cell);

}  // namespace galactic::pictures
