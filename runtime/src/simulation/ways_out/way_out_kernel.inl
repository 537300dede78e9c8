// The kernels of ways out, in terms of vectors of eight spheres: included after lanes_eight.inl by
// way_out_portable.cpp and way_out_avx2.cpp, which differ in nothing else but the instructions that
// they may use. No library templates here: see column_grid_avx2.cpp.
namespace galactic::simulation {
namespace {

inline Lanes choose(IntLanes mask, Lanes yes, Lanes no) { return mask ? yes : no; }

inline Lanes lesserOf(Lanes a, Lanes b) { return b < a ? b : a; }

/// Rows of sixteen bits.
using Rows = std::uint16_t __attribute__((vector_size(32)));

inline Rows loadRows(const std::uint16_t* from) {
  Rows rows;
  __builtin_memcpy(&rows, from, sizeof(rows));
  return rows;
}

/// From bit `column` on.
inline Rows shiftedRows(Rows rows, std::int32_t column) {
#if defined(__AVX2__)
  return reinterpret_cast<Rows>(
      _mm256_srl_epi16(reinterpret_cast<__m256i>(rows), _mm_cvtsi32_si128(column)));
#else
  return rows >> static_cast<std::uint16_t>(column);
#endif
}

/// Whether all cells that count are among them.
inline bool areAllCells(Rows rows) {
  constexpr std::uint16_t kNine = 0x1ff;
  const Rows all{kNine, kNine, kNine, kNine, kNine, kNine, kNine, kNine, kNine};
  const Rows missing = ~rows & all;
  std::uint64_t words[4];
  __builtin_memcpy(words, &missing, sizeof(words));
  return (words[0] | words[1] | words[2]) == 0;
}

bool addKernel(const std::uint16_t* rows, const EightPlaces& places, unsigned spheres,
               EightWays& ways, CommonCells& common) noexcept {
  const IntLanes added = lanesOf(spheres);
  storeInts(ways.row, loadInts(places.row) & added);
  storeInts(ways.column, loadInts(places.column) & added);
  store(ways.part_x, load(places.part_x));
  store(ways.part_z, load(places.part_z));
  ways.rows = rows;
  ways.spheres = spheres;
  Rows cells = shiftedRows(loadRows(rows + ways.row[0]), ways.column[0]);
  for (std::size_t n = 1; n < kLanes; ++n) {
    cells &= shiftedRows(loadRows(rows + ways.row[n]), ways.column[n]);
  }
  __builtin_memcpy(ways.cells.rows, &cells, sizeof(cells));
  const Rows both = loadRows(common.rows) & cells;
  __builtin_memcpy(common.rows, &both, sizeof(both));
  return !areAllCells(cells);
}

/// Cells of spheres, the same for all, around one where two rows meet.
struct CellsBefore {
  /// Rows of 16 bits from a sphere's first to the lower of them.
  std::ptrdiff_t first_row = 0;
  /// The bits of cells for a sphere in column 0, both rows side by side.
  int x = 0;
  int z = 0;
  int both = 0;
};

inline CellsBefore cellsBefore(const WayCell& to) {
  const WayCell before{to.x - signOf(to.x), to.z - signOf(to.z)};
  const int first = to.z < before.z ? to.z : before.z;
  const auto bit = [first](int x, int z) { return 16 * (z - first) + x + kCellsAround; };
  return {first + kCellsAround, bit(before.x, to.z), bit(to.x, before.z), bit(before.x, before.z)};
}

/// Whether one of eight spheres is not free in one of the cells.
inline bool decides(const EightWays& ways, const CellsBefore& cells) {
  std::uint32_t rows = 0;
  __builtin_memcpy(&rows, ways.cells.rows + cells.first_row, sizeof(rows));
  return ((rows >> cells.x & rows >> cells.z & rows >> cells.both) & 1U) == 0;
}

/// What decides how much of a move spheres can take back.
struct WayLanes {
  /// The signs say where a sphere is free.
  IntLanes free_x, free_z, free_both;
  /// From the border that the move crosses last.
  Lanes to_border_x, to_border_z;
};

/// How far places in a cell are from the border that a move towards `sign` crosses last: as they
/// are, or 1 less them, with no rounding more than that, and no branch.
inline Lanes fromBorder(const float* part, int sign) {
  const int backwards = sign > 0 ? 0 : 1;
  return spread(static_cast<float>(1 - 2 * backwards)) * load(part) +
         spread(static_cast<float>(backwards));
}

/// The row of each sphere in which a move ends, and that before it.
inline IntLanes rowsAt(const EightWays& ways, const CellsBefore& cells) {
  return gather<2>(ways.rows + cells.first_row, loadInts(ways.row), lanesOf(0xff));
}

inline WayLanes lanesBefore(const EightWays& ways, IntLanes rows, const CellsBefore& cells,
                            const WayCell& to) {
  // The bit of a cell, as the sign.
  const IntLanes above = 31 - loadInts(ways.column);
  return {rows << (above - cells.x), rows << (above - cells.z), rows << (above - cells.both),
          fromBorder(ways.part_x, to.x), fromBorder(ways.part_z, to.z)};
}

TakenBackBoth takenBackKernel(const EightWays* ways, std::size_t count, const CellMove& move,
                              DecidingEight* deciding) noexcept {
  const CellsBefore cells = cellsBefore(move.to);
  // Most eights are free in all of these cells.
  std::size_t deciding_count = 0;
  for (std::size_t first = 0; first < count; first += kWaysAtATime) {
    for (std::size_t n = first; n < first + kWaysAtATime; ++n) {
      deciding[deciding_count].ways = ways + n;
      deciding_count +=
          static_cast<std::size_t>(decides(ways[n], cells)) & static_cast<std::size_t>(n < count);
    }
  }
  const Lanes whole = spread(1);
  Lanes least_x = whole;
  Lanes least_z = whole;
  for (std::size_t n = 0; n < deciding_count; ++n) {
    const IntLanes rows = rowsAt(*deciding[n].ways, cells);
    storeInts(deciding[n].rows, rows);
    const WayLanes way = lanesBefore(*deciding[n].ways, rows, cells, move.to);
    least_x = lesserOf(least_x, choose(way.free_x < 0, whole, way.to_border_x));
    least_z = lesserOf(least_z, choose(way.free_z < 0, whole, way.to_border_z));
  }
  TakenBack first;
  leastOf(least_x, least_z, first.x, first.z);
  const Lanes margin = spread(move.margin);
  least_x = least_z = whole;
  for (std::size_t n = 0; n < deciding_count; ++n) {
    const WayLanes way = lanesBefore(*deciding[n].ways, loadInts(deciding[n].rows), cells, move.to);
    const IntLanes behind_x = (way.to_border_x - spread(first.x)) + margin < spread(0);
    const IntLanes behind_z = (way.to_border_z - spread(first.z)) + margin < spread(0);
    const IntLanes free_z = behind_x ? way.free_both : way.free_z;
    const IntLanes free_x = behind_z ? way.free_both : way.free_x;
    least_x = lesserOf(least_x, choose(free_x < 0, whole, way.to_border_x));
    least_z = lesserOf(least_z, choose(free_z < 0, whole, way.to_border_z));
  }
  TakenBack second;
  leastOf(least_x, least_z, second.x, second.z);
  return {{first.x, second.z}, {second.x, first.z}};
}

/// The cells along one axis that a place may be in, from a sphere's own.
struct CellRange {
  int first = 0;
  int last = 0;
};

inline CellRange cellsAfter(float part, float by, float rounding) {
  if (by == 0) return {};
  const float cell = part + by + kAboveCells;
  constexpr auto kAbove = static_cast<int>(kAboveCells);
  return {static_cast<int>(cell - rounding) - kAbove, static_cast<int>(cell + rounding) - kAbove};
}

inline bool isFreeIn(const EightWays& ways, std::size_t sphere, int x, int z) {
  const std::uint16_t row = ways.rows[ways.row[sphere] + z + kCellsAround];
  return (static_cast<unsigned>(row) >> (ways.column[sphere] + x + kCellsAround) & 1U) != 0;
}

inline bool isFreeEverywhere(const EightWays& ways, std::size_t sphere) {
  for (int z = -kCellsAround; z <= kCellsAround; ++z) {
    for (int x = -kCellsAround; x <= kCellsAround; ++x) {
      if (!isFreeIn(ways, sphere, x, z)) return false;
    }
  }
  return true;
}

inline bool isFreeAfter(const EightWays& ways, std::size_t sphere, const CellPush& by) {
  const CellRange x = cellsAfter(ways.part_x[sphere], by.x, by.rounding);
  const CellRange z = cellsAfter(ways.part_z[sphere], by.z, by.rounding);
  const bool is_known = x.first >= -kCellsAround && z.first >= -kCellsAround &&
                        x.last <= kCellsAround && z.last <= kCellsAround;
  // What no cell around it blocks goes anywhere.
  if (!is_known) return isFreeEverywhere(ways, sphere);
  return isFreeIn(ways, sphere, x.first, z.first) && isFreeIn(ways, sphere, x.first, z.last) &&
         isFreeIn(ways, sphere, x.last, z.first) && isFreeIn(ways, sphere, x.last, z.last);
}

/// Where places end near the border of a cell. What does not move along an axis may be at its
/// border.
inline IntLanes isNearBorder(const float* part, float by, float near) {
  const Lanes move = spread(by);
  const Lanes cell = (load(part) + move) + spread(kAboveCells);
  const Lanes shift = spread(12582912.0F);  // 1.5 * 2^23: leaves no bits for a fraction
  const Lanes from_whole = cell - ((cell + shift) - shift);
  return (from_whole <= near) & (from_whole >= -near) & (move != 0);
}

bool areFreeKernel(const EightWays* ways, std::size_t count, const CellPush& by) noexcept {
  for (std::size_t n = 0; n < count; ++n) {
    const IntLanes near =
        isNearBorder(ways[n].part_x, by.x, by.near) | isNearBorder(ways[n].part_z, by.z, by.near);
    for (unsigned left = signsOf(near) & ways[n].spheres; left != 0; left &= left - 1) {
      if (!isFreeAfter(ways[n], static_cast<std::size_t>(__builtin_ctz(left)), by)) return false;
    }
  }
  return true;
}

}  // namespace
}  // namespace galactic::simulation
