#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "galactic/pose.h"

namespace galactic {

/// The answer to "may the sphere's center be here?".
enum class Clearance : std::uint8_t {
  kFree = 0,     ///< Inside a free span, both ends included.
  kBlocked = 1,  ///< Inside the grid but in no free span; also if a coordinate is NaN.
  kOutside = 2,  ///< Outside the grid's rectangle or its range of heights: unknown.
};

/// Clearance, and the distances to contact along the vertical line.
struct Contact {
  Clearance clearance = Clearance::kBlocked;
  /// How far the sphere can move down and up before it touches something, meters; 0 unless free.
  /// Smaller by some millionths of the grid's height than the exact distance, so that the sphere is
  /// free wherever it gets by moving this far or less.
  float down = 0;
  float up = 0;
};

/// Centers of n spheres in the world frame, as three arrays of the same length.
struct SphereCenters {
  std::span<const float> x;
  std::span<const float> y;
  std::span<const float> z;
};

/// Arrays for the answers of a batched query, as long as the centers. `down` and `up` may both be
/// empty if only the clearance is wanted.
struct ContactArrays {
  std::span<Clearance> clearance;
  std::span<float> down{};
  std::span<float> up{};
};

/// A cell of a grid, and the column over its middle: i along x, k along z.
struct ColumnIndex {
  std::uint32_t i = 0;
  std::uint32_t k = 0;

  friend bool operator==(const ColumnIndex&, const ColumnIndex&) = default;
};

/// Where a grid's cells lie and how their codes are decoded; plain data, pointing into a pack.
/// docs/packs.md describes the layout.
struct ColumnGridLayout {
  float radius = 0;
  float spacing = 0;
  float inverse_spacing = 0;
  float min_x = 0;
  float min_z = 0;
  Span heights;
  float quantum = 0;
  float inverse_quantum = 0;
  std::uint32_t columns_x = 0;
  std::uint32_t columns_z = 0;
  std::uint32_t tiles_x = 0;
  const std::uint64_t* cells = nullptr;
  /// nullptr when the whole grid fits in one range of codes.
  const std::uint16_t* tile_base = nullptr;
  /// One of the next two: spans of overflow cells as pairs of codes, or as heights if codes do not
  /// reach that far.
  const std::uint32_t* overflow_codes = nullptr;
  const Span* overflow_spans = nullptr;
};

/// The free heights of all columns of one scene for one sphere radius (paper, appendix G): a view
/// into a mapped pack, cheap to copy, valid as long as the pack is open. All members are safe to
/// call from many threads.
class ColumnGrid {
 public:
  explicit ColumnGrid(const ColumnGridLayout& layout) : layout_(layout) {}

  /// Sphere radius and cell edge, meters.
  [[nodiscard]] float radius() const { return layout_.radius; }
  [[nodiscard]] float spacing() const { return layout_.spacing; }
  [[nodiscard]] std::uint32_t columnsX() const { return layout_.columns_x; }
  [[nodiscard]] std::uint32_t columnsZ() const { return layout_.columns_z; }
  /// The range of heights that the grid answers for.
  [[nodiscard]] Span heights() const { return layout_.heights; }
  [[nodiscard]] const ColumnGridLayout& layout() const { return layout_; }

  /// Whether a sphere centered at `center` (world frame) is free, judged by the nearest column.
  [[nodiscard]] Clearance clearance(Vec3 center) const noexcept;

  /// The same, with the distances down and up to contact in that column.
  [[nodiscard]] Contact contact(Vec3 center) const noexcept;

  /// The same in a column of the caller's choice, at height `y`: for callers that go from cell to
  /// cell. kOutside if there is no such column.
  [[nodiscard]] Contact contact(ColumnIndex column, float y) const noexcept;

  /// `contact` for each center, eight at a time where the processor has AVX2 (chosen at run time).
  /// The answers equal those of `contact` bit for bit. Neither allocates nor throws.
  /// All spans of `centers` and `out.clearance` must have the same length; `out.down` and `out.up`
  /// must have that length or both be empty.
  void contact(const SphereCenters& centers, const ContactArrays& out) const noexcept;

  /// Index of the first of these centers that is not free, or the number of centers if all are
  /// free. Gives the same answer as `contact`, but faster. Neither allocates nor throws.
  [[nodiscard]] std::size_t firstNotFree(const SphereCenters& centers) const noexcept;

  /// The column by which a query at (x, z) is judged; none outside the grid, or if a coordinate is
  /// NaN.
  [[nodiscard]] std::optional<ColumnIndex> columnAt(float x, float z) const noexcept;

  /// Number of free spans in column (i, k); 0 outside the grid.
  [[nodiscard]] std::size_t spanCount(std::uint32_t i, std::uint32_t k) const noexcept;

  /// Copies the free spans of column (i, k), ascending, as many as fit into `out`; returns how many
  /// there are, 0 outside the grid. A query at any height of a span, its ends included, answers
  /// kFree.
  std::size_t spans(std::uint32_t i, std::uint32_t k, std::span<Span> out) const noexcept;

 private:
  ColumnGridLayout layout_;
};

}  // namespace galactic
