#include "render/simplify_within.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sphere_set/triangle_tree.h"
#include "vec3d.h"

namespace galactic::bake {
namespace {

/// How often corners are kept before the piece stays as it is.
constexpr int kRoundsOfKeeping = 5;
/// Shares of the error that quadrics are asked for. On evenly curved surfaces a smaller one leaves
/// fewer triangles, because fewer corners have to be kept; on flat ones with edges a larger one
/// does.
constexpr std::array<double, 3> kSharesAsked{1, 0.5, 0.25};
/// A corner's colour that differs by more from the mean of its neighbours' is a detail to keep, of
/// 255: about what an eye sees in a small image.
constexpr int kColorDetail = 12;

constexpr std::size_t kChannels = 3;

int channelOf(std::uint32_t color, std::size_t channel) {
  return static_cast<int>(color >> (8 * channel) & 0xFFU);
}

bool hasOneColor(const PartMesh& piece) {
  return std::all_of(piece.vertices.begin(), piece.vertices.end(), [&](const RenderVertex& v) {
    return v.color == piece.vertices.front().color;
  });
}

/// The corners whose colour cannot be told from their neighbours'. Seams of colours are seams of
/// the surface and need no mark.
std::vector<bool> coloredDetails(const PartMesh& piece) {
  std::vector<bool> details(piece.vertices.size());
  if (hasOneColor(piece)) return details;
  std::vector<std::array<int, kChannels>> sums(piece.vertices.size());
  std::vector<int> counts(piece.vertices.size());
  for (const Triangle& triangle : piece.triangles) {
    for (std::size_t n = 0; n < 3; ++n) {
      for (const std::size_t other : {(n + 1) % 3, (n + 2) % 3}) {
        ++counts[triangle[n]];
        for (std::size_t c = 0; c < kChannels; ++c) {
          sums[triangle[n]][c] += channelOf(piece.vertices[triangle[other]].color, c);
        }
      }
    }
  }
  for (std::size_t n = 0; n < details.size(); ++n) {
    for (std::size_t c = 0; c < kChannels; ++c) {
      const int own = counts[n] * channelOf(piece.vertices[n].color, c);
      if (std::abs(own - sums[n][c]) > counts[n] * kColorDetail) details[n] = true;
    }
  }
  return details;
}

sphere_fit::TriangleTree treeOf(const PartMesh& piece, const std::vector<Triangle>& triangles) {
  std::vector<sphere_fit::Facet> facets;
  facets.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    facets.push_back({piece.vertices[t[0]].position, piece.vertices[t[1]].position,
                      piece.vertices[t[2]].position});
  }
  return sphere_fit::TriangleTree(std::move(facets));
}

Vec3d middleOf(const PartMesh& piece, const Triangle& t) {
  return (widen(piece.vertices[t[0]].position) + widen(piece.vertices[t[1]].position) +
          widen(piece.vertices[t[2]].position)) *
         (1.0 / 3);
}

/// Measures how far the source lies from what became of it, and marks corners that are too far off.
class Deviation {
 public:
  Deviation(const PartMesh& piece, double allowed) : piece_(piece), allowed_(allowed) {}

  /// Whether all of the source is near enough; if not, there are new marks in `kept`.
  bool check(const std::vector<Triangle>& triangles, std::vector<bool>& kept) {
    const sphere_fit::TriangleTree tree = treeOf(piece_, triangles);
    largest_ = 0;
    bool near = true;
    for (std::uint32_t n = 0; n < piece_.vertices.size(); ++n) {
      if (kept[n] || isNear(tree, widen(piece_.vertices[n].position))) continue;
      kept[n] = true;
      near = false;
    }
    for (const Triangle& triangle : piece_.triangles) {
      if (isNear(tree, middleOf(piece_, triangle))) continue;
      near = false;
      for (const std::uint32_t corner : triangle) kept[corner] = true;
    }
    return near;
  }

  /// Of the last check, metres.
  [[nodiscard]] double largest() const { return largest_; }

 private:
  bool isNear(const sphere_fit::TriangleTree& tree, const Vec3d& point) {
    const double distance = std::sqrt(tree.nearest({point.x, point.y, point.z}).squared);
    largest_ = std::max(largest_, distance);
    return distance <= allowed_;
  }

  const PartMesh& piece_;
  double allowed_;
  double largest_ = 0;
};

/// The piece simplified by what quadrics estimate as `asked`, corners kept until all of it is near
/// enough; the piece itself if that takes too many rounds.
Simplified simplifyKeeping(const PartMesh& piece, double asked, Deviation& deviation,
                           std::vector<bool> kept) {
  for (int round = 0; round <= kRoundsOfKeeping; ++round) {
    Simplified simplified = simplify(piece, asked, kept);
    if (simplified.triangles.empty()) break;
    if (!deviation.check(simplified.triangles, kept)) continue;
    simplified.error = deviation.largest();
    return simplified;
  }
  return {piece.triangles, 0};
}

}  // namespace

Simplified simplifyWithin(const PartMesh& piece, double error) {
  const std::vector<bool> details = coloredDetails(piece);
  Deviation deviation(piece, error);
  Simplified best{piece.triangles, 0};
  for (const double share : kSharesAsked) {
    Simplified simplified = simplifyKeeping(piece, share * error, deviation, details);
    if (simplified.triangles.size() < best.triangles.size()) best = std::move(simplified);
  }
  return best;
}

}  // namespace galactic::bake
