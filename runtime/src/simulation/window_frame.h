#pragma once
#include <cstddef>
#include <cstdint>

#include "galactic/vec3.h"

namespace galactic::simulation {

/// Where the four shifted regular grids of one scene lie (paper, appendix G). A cell of the paper
/// is at least four times the largest radius wide; the second grid is shifted by half a cell in x,
/// the third in z, the fourth in both, so any sphere of the working set lies inside one cell of one
/// of them. The cells of all four begin at the points of one lattice with half a cell between its
/// points, and each point begins exactly one cell; so the four grids are stored as one array of
/// windows, and which of them holds a sphere follows from the half cell that its centre is in:
/// window (i, k) answers for the spheres with centres in [i, i + 1) x [k, k + 1) half cells and
/// knows the objects within the largest radius of that square. With half cells of twice that radius
/// this is the paper's cell; larger half cells need less room around them.
struct WindowFrame {
  /// Corner of half cell (0, 0), metres.
  float min_x = 0;
  float min_z = 0;
  /// Of half a cell, 1 / metres.
  float inverse_half_cell = 0;
  float largest_radius = 0;
  std::uint32_t windows_x = 0;
  std::uint32_t windows_z = 0;

  [[nodiscard]] std::size_t windowCount() const {
    return static_cast<std::size_t>(windows_x) * windows_z;
  }
};

/// The frame that covers the rectangle [min_x, max_x] x [min_z, max_z], metres; `largest_radius` of
/// the working set, metres, > 0. Large scenes get larger half cells, so that no frame has more than
/// kMostWindows windows.
[[nodiscard]] WindowFrame makeWindowFrame(Span x, Span z, float largest_radius);

/// Four kilobytes of windows per plane: see makeWindowFrame.
inline constexpr std::size_t kMostWindows = 4096;

}  // namespace galactic::simulation
