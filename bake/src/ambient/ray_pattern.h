#pragma once
#include <array>
#include <vector>

namespace galactic::bake {

/// One ray of the pattern, in terms of the triangles around a vertex.
struct PatternRay {
  /// Chooses the triangle in proportion to area: 0 to 1.
  double triangle = 0;
  /// Where in the triangle the ray starts: the barycentric coordinates of the vertex itself and of
  /// the corner after it. The density is proportional to `own`.
  double own = 0;
  double next = 0;
  /// Unit direction, cosine-weighted about the third axis.
  std::array<double, 3> direction{};
};

/// `count` rays spread evenly over triangles, positions and directions at once (Hammersley points).
[[nodiscard]] std::vector<PatternRay> rayPattern(unsigned count);

}  // namespace galactic::bake
