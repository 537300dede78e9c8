#include "layout/cluster_split.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include "layout/morton.h"

namespace galactic::render {
namespace {

constexpr std::uint8_t kNotIn = 255;
static_assert(kMostInCluster < kNotIn);

/// Positions along a Morton curve through the cube around a surface.
class MortonCurve {
 public:
  explicit MortonCurve(const std::vector<RenderVertex>& vertices) : low_(vertices[0].position) {
    Vec3 high = low_;
    for (const RenderVertex& vertex : vertices) {
      const Vec3& p = vertex.position;
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const double edge = std::max({static_cast<double>(high.x) - static_cast<double>(low_.x),
                                  static_cast<double>(high.y) - static_cast<double>(low_.y),
                                  static_cast<double>(high.z) - static_cast<double>(low_.z)});
    scale_ = edge > 0 ? kCells / edge : 0;
  }

  [[nodiscard]] std::uint64_t at(const RenderSurface& surface, std::size_t triangle) const {
    std::array<double, 3> sum{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3& p = surface.vertices[surface.corners[3 * triangle + corner]].position;
      sum[0] += static_cast<double>(p.x) - static_cast<double>(low_.x);
      sum[1] += static_cast<double>(p.y) - static_cast<double>(low_.y);
      sum[2] += static_cast<double>(p.z) - static_cast<double>(low_.z);
    }
    const auto cell = [&](double of_three) {
      return static_cast<std::uint64_t>(of_three / 3 * scale_);
    };
    return mortonPlace(cell(sum[0]), cell(sum[1]), cell(sum[2]));
  }

 private:
  static constexpr double kCells = (1U << 21U) - 1;
  Vec3 low_;
  double scale_ = 0;
};

std::vector<std::uint32_t> mortonOrder(const RenderSurface& surface) {
  const MortonCurve curve(surface.vertices);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(surface.corners.size() / 3);
  for (std::uint32_t n = 0; n < keys.size(); ++n) keys[n] = {curve.at(surface, n), n};
  std::ranges::sort(keys);
  std::vector<std::uint32_t> order(keys.size());
  std::ranges::transform(keys, order.begin(), [](const auto& key) { return key.second; });
  return order;
}

/// The surface as it is, if it is small enough for one cluster.
ClusterDraft wholeSurface(const RenderSurface& surface) {
  ClusterDraft draft;
  draft.vertices.resize(surface.vertices.size());
  std::iota(draft.vertices.begin(), draft.vertices.end(), 0U);
  draft.triangles.resize(surface.corners.size() / 3);
  for (std::size_t n = 0; n < surface.corners.size(); ++n) {
    draft.triangles[n / 3][n % 3] = static_cast<std::uint8_t>(surface.corners[n]);
  }
  return draft;
}

/// Fills one draft after another.
class Splitter {
 public:
  explicit Splitter(const RenderSurface& surface)
      : surface_(surface), place_(surface.vertices.size(), kNotIn) {}

  void add(std::uint32_t triangle) {
    const std::array<std::uint32_t, 3> corners{surface_.corners[3 * std::size_t{triangle}],
                                               surface_.corners[3 * std::size_t{triangle} + 1],
                                               surface_.corners[3 * std::size_t{triangle} + 2]};
    const auto fresh = static_cast<std::size_t>(std::ranges::count_if(
        corners, [&](std::uint32_t corner) { return place_[corner] == kNotIn; }));
    if (draft_.triangles.size() == kMostInCluster ||
        draft_.vertices.size() + fresh > kMostInCluster) {
      finishDraft();
    }
    std::array<std::uint8_t, 3>& stored = draft_.triangles.emplace_back();
    for (std::size_t n = 0; n < 3; ++n) stored[n] = placeOf(corners[n]);
  }

  std::vector<ClusterDraft> take() {
    finishDraft();
    return std::move(drafts_);
  }

 private:
  std::uint8_t placeOf(std::uint32_t vertex) {
    if (place_[vertex] == kNotIn) {
      place_[vertex] = static_cast<std::uint8_t>(draft_.vertices.size());
      draft_.vertices.push_back(vertex);
    }
    return place_[vertex];
  }

  void finishDraft() {
    if (draft_.triangles.empty()) return;
    for (const std::uint32_t vertex : draft_.vertices) place_[vertex] = kNotIn;
    drafts_.push_back(std::exchange(draft_, {}));
  }

  const RenderSurface& surface_;
  /// The place of each vertex in the draft.
  std::vector<std::uint8_t> place_;
  ClusterDraft draft_;
  std::vector<ClusterDraft> drafts_;
};

}  // namespace

std::vector<ClusterDraft> splitSurface(const RenderSurface& surface) {
  if (surface.corners.empty()) return {};
  if (surface.vertices.size() <= kMostInCluster && surface.corners.size() / 3 <= kMostInCluster) {
    return {wholeSurface(surface)};
  }
  Splitter splitter(surface);
  for (const std::uint32_t triangle : mortonOrder(surface)) splitter.add(triangle);
  return splitter.take();
}

}  // namespace galactic::render
