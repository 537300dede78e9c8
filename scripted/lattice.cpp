#include "scripted/lattice.h"

#include <algorithm>
#include <cmath>

namespace galactic::scripted {
namespace {

Lattice over(const GroundArea& area, float edge) {
  const auto first = [edge](float least) {
    return static_cast<std::int32_t>(std::floor(least / edge));
  };
  const auto last = [edge](float most) {
    return static_cast<std::int32_t>(std::ceil(most / edge));
  };
  const auto count = [&](float least, float most) {
    return static_cast<std::uint32_t>(std::max(last(most) - first(least) + 1, 0));
  };
  return {edge, first(area.min_x), first(area.min_z), count(area.min_x, area.max_x),
          count(area.min_z, area.max_z)};
}

/// `part` widened by a margin, but no farther than `whole`.
GroundArea widened(const GroundArea& part, float margin, const GroundArea& whole) {
  return {std::max(part.min_x - margin, whole.min_x), std::min(part.max_x + margin, whole.max_x),
          std::max(part.min_z - margin, whole.min_z), std::min(part.max_z + margin, whole.max_z)};
}

}  // namespace

std::optional<std::uint32_t> Lattice::cellAt(float x, float z) const {
  const auto i = static_cast<std::int32_t>(std::lround(x / edge)) - first_i;
  const auto k = static_cast<std::int32_t>(std::lround(z / edge)) - first_k;
  const bool inside = i >= 0 && k >= 0 && i < static_cast<std::int32_t>(count_i) &&
                      k < static_cast<std::int32_t>(count_k);
  if (!inside) return std::nullopt;
  return static_cast<std::uint32_t>(k) * count_i + static_cast<std::uint32_t>(i);
}

Vec3 Lattice::placeOf(std::uint32_t cell) const {
  const auto i = static_cast<std::int32_t>(cell % count_i) + first_i;
  const auto k = static_cast<std::int32_t>(cell / count_i) + first_k;
  return {static_cast<float>(i) * edge, 0, static_cast<float>(k) * edge};
}

std::optional<Lattice> layOut(const GroundArea& whole, const GroundArea& part, float edge,
                              std::size_t most_cells) {
  const Lattice all = over(whole, edge);
  if (all.cells() <= most_cells) return all;
  const auto with_margin = [&](std::uint32_t cells) {
    return over(widened(part, static_cast<float>(cells) * edge, whole), edge);
  };
  if (with_margin(0).cells() > most_cells) return std::nullopt;
  std::uint32_t fits = 0;
  std::uint32_t too_many = std::max(all.count_i, all.count_k);
  while (too_many - fits > 1) {
    const std::uint32_t middle = fits + (too_many - fits) / 2;
    (with_margin(middle).cells() <= most_cells ? fits : too_many) = middle;
  }
  return with_margin(fits);
}

}  // namespace galactic::scripted
