#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

#include "galactic/pose.h"

namespace galactic::scripted {

/// Places on a floor, `edge` apart, in rows along X and Z of the world: cells.
struct Lattice {
  /// Meters.
  float edge = 0;
  /// Place (i, k) is at (i, k) times the edge.
  std::int32_t first_i = 0;
  std::int32_t first_k = 0;
  std::uint32_t count_i = 0;
  std::uint32_t count_k = 0;

  friend bool operator==(const Lattice&, const Lattice&) = default;

  [[nodiscard]] std::size_t cells() const { return std::size_t{count_i} * count_k; }
  /// The nearest cell, if the lattice contains it.
  [[nodiscard]] std::optional<std::uint32_t> cellAt(float x, float z) const;
  /// World frame, y 0.
  [[nodiscard]] Vec3 placeOf(std::uint32_t cell) const;
};

/// A part of the ground plane, meters.
struct GroundArea {
  float min_x = 0;
  float max_x = 0;
  float min_z = 0;
  float max_z = 0;
};

/// The lattice over `whole` or, if that has more than `most_cells`, over as much of it around
/// `part` as has no more. None if the part alone has more.
[[nodiscard]] std::optional<Lattice> layOut(const GroundArea& whole, const GroundArea& part,
                                            float edge, std::size_t most_cells);

}  // namespace galactic::scripted
