#pragma once
#include <array>
#include <vector>

namespace galactic::bake {

/// One ray of the pattern, in terms of the triangles around a vertex.
struct PatternRay {
  /// Chooses the triangle, by area: 0 to 1.
  double triangle = 0;
  /// Where in the triangle it starts: barycentric coordinate of the vertex in question, and of the
  /// corner after it. Density proportional to the first.
  double own = 0;
  double next = 0;
  /// Unit direction, cosine-weighted about the third axis.
  std::array<double, 3> direction{};
};

/// `count` rays, spread evenly over triangles, places and directions together: Hammersley points.
[[nodiscard]] std::vector<PatternRay> rayPattern(unsigned count);

}  // namespace galactic::bake
