// The kernels of ways out, with vectors of eight spheres. Included after lanes_eight.inl and
// operations.inl by way_out_portable.cpp and way_out_avx2.cpp, which differ only in the
// instructions that they may use. No library templates here: see column_grid_avx2.cpp.
namespace galactic::simulation {
namespace {

/// Rows of sixteen bits.
using Rows = std::uint16_t __attribute__((vector_size(32)));

/// The bits of a row that count, those behind the middle one, and those before it; then all cells
/// that count, and the rows before and behind the middle one.
constexpr std::uint16_t kNine = 0x1ff;
constexpr std::uint16_t kBehind = 0x1e0;
constexpr std::uint16_t kBefore = 0x00f;
constexpr Rows kCells{kNine, kNine, kNine, kNine, kNine, kNine, kNine, kNine, kNine};
constexpr Rows kRowsBefore{kNine, kNine, kNine, kNine};
constexpr Rows kRowsBehind{0, 0, 0, 0, 0, kNine, kNine, kNine, kNine};
/// All cells but the middle one.
constexpr Rows kElsewhere{kNine, kNine, kNine, kNine, kBefore | kBehind,
                          kNine, kNine, kNine, kNine};

inline Rows loadRows(const std::uint16_t* from) {
  Rows rows;
  __builtin_memcpy(&rows, from, sizeof(rows));
  return rows;
}

/// The same for rows that were written in halves: a load of the whole would stall.
inline Rows loadHalves(const std::uint16_t* from) {
  using Half = std::uint16_t __attribute__((vector_size(16)));
  Half first;
  Half second;
  __builtin_memcpy(&first, from, sizeof(first));
  __builtin_memcpy(&second, from + 8, sizeof(second));
  return __builtin_shufflevector(first, second, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14,
                                 15);
}

/// Shifts rows so that they begin with bit `column`.
inline Rows shiftedRows(Rows rows, std::int32_t column) {
#if defined(__AVX2__)
  return reinterpret_cast<Rows>(
      _mm256_srl_epi16(reinterpret_cast<__m256i>(rows), _mm_cvtsi32_si128(column)));
#else
  return rows >> static_cast<std::uint16_t>(column);
#endif
}

/// Whether `rows` has all cells that count.
inline bool areAllCells(Rows rows) {
  const Rows missing = ~rows & kCells;
  std::uint64_t words[4];
  __builtin_memcpy(words, &missing, sizeof(words));
  return (words[0] | words[1] | words[2]) == 0;
}

/// Whether `rows` has any cell that counts.
inline bool isAnyCell(Rows rows) {
  const Rows counted = rows & kCells;
  std::uint64_t words[4];
  __builtin_memcpy(words, &counted, sizeof(words));
  return (words[0] | words[1] | words[2]) != 0;
}

bool leaveUnblockedKernel(const GroupsToAdd& given, CommonCells& cells) noexcept {
  const GroupsToAdd some = given;
  // The blocked rows of a tile follow its free rows; in the first tile nothing is blocked. Sixteen
  // rows are loaded so that the nine that count are the last, because memory may end after them.
  constexpr std::ptrdiff_t kRowsThatDoNot = 7;
  const std::uint16_t* rows = some.rows + SliceTile::kRows - kRowsThatDoNot;
  Rows left_over = loadRows(cells.rows);
  for (unsigned left = some.asked; left != 0; left &= left - 1) {
    const auto n = static_cast<std::size_t>(__builtin_ctz(left));
    const EightPlaces& places = some.places[n];
    const IntLanes counted = lanesOf(some.groups[n].spheres & places.inside);
    const IntLanes row = loadInts(places.row) & counted;
    const IntLanes column = loadInts(places.column) & counted;
    Rows blocked = shiftedRows(loadRows(rows + row[0]), column[0]);
    for (std::size_t lane = 1; lane < kLanes; ++lane) {
      blocked |= shiftedRows(loadRows(rows + row[lane]), column[lane]);
    }
    const Rows none{};
    left_over &= ~__builtin_shufflevector(blocked, none, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17,
                                          18, 19, 20, 21, 22);
  }
  __builtin_memcpy(cells.rows, &left_over, sizeof(left_over));
  return isAnyCell(left_over);
}

/// Makes ways of spheres. Returns the cells in which all of them are free.
inline Rows addEight(const std::uint16_t* rows, const EightPlaces& places, unsigned spheres,
                     EightWays& ways) {
  const IntLanes added = lanesOf(spheres);
  const IntLanes row = loadInts(places.row) & added;
  const IntLanes column = loadInts(places.column) & added;
  storeInts(ways.row, row);
  storeInts(ways.column, column);
  store(ways.part_x, load(places.part_x));
  store(ways.part_z, load(places.part_z));
  ways.rows = rows;
  ways.spheres = spheres;
  Rows cells = shiftedRows(loadRows(rows + row[0]), column[0]);
  for (std::size_t n = 1; n < kLanes; ++n) {
    cells &= shiftedRows(loadRows(rows + row[n]), column[n]);
  }
  __builtin_memcpy(ways.cells.rows, &cells, sizeof(cells));
  return cells;
}

bool addKernel(const std::uint16_t* rows, const EightPlaces& places, unsigned spheres,
               EightWays& ways, CommonCells& common) noexcept {
  const Rows cells = addEight(rows, places, spheres, ways);
  const Rows both = loadRows(common.rows) & cells;
  __builtin_memcpy(common.rows, &both, sizeof(both));
  return !areAllCells(cells);
}

AddedGroups addGroupsKernel(const GroupsToAdd& given, EightWays* ways,
                            CommonCells& common) noexcept {
  // A copy, so that the compiler knows that no write below changes it.
  const GroupsToAdd some = given;
  AddedGroups found;
  Rows both = loadHalves(common.rows);
  for (unsigned left = some.asked; left != 0; left &= left - 1) {
    const auto n = static_cast<std::size_t>(__builtin_ctz(left));
    const EightPlaces& places = some.places[n];
    const unsigned spheres = some.groups[n].spheres;
    const auto blocked = static_cast<unsigned>(some.blocked >> (n * kLanes));
    const unsigned wanted = spheres & (places.free | blocked);
    const unsigned added = wanted & places.inside;
    found.whole |= static_cast<unsigned>(wanted == spheres) << n;
    found.outside |= static_cast<unsigned>(wanted != added) << n;
    const Rows cells = addEight(some.rows, places, added, ways[found.count]);
    both &= cells;
    found.count += static_cast<std::size_t>(!areAllCells(cells));
  }
  __builtin_memcpy(common.rows, &both, sizeof(both));
  return found;
}

/// 1, 0 or -1.
constexpr int signOf(int value) { return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0); }

/// The cells that a move by whole cells leaves last, the same for all spheres: the neighbors of its
/// end one cell back along X, along Z, and along both.
struct CellsBefore {
  /// Rows of 16 bits from a sphere's first row to the lower of the two rows that contain the cells.
  std::int32_t first_row = 0;
  /// Their bits for a sphere in column 0, with both rows side by side: one back along X, Z, and
  /// both.
  std::int32_t x = 0;
  std::int32_t z = 0;
  std::int32_t both = 0;
  /// All three bits.
  std::uint32_t bits = 0;
};

/// Converts a position in a cell along an axis to the distance from the border that a move crosses
/// last: times * position + plus, which is the position itself or 1 minus it.
struct FromBorder {
  float times = 0;
  float plus = 0;
};

/// A move by whole cells, and everything about it that is the same for all spheres.
struct alignas(64) CellMove {
  /// Cells along each axis, and the direction.
  float x = 0;
  float z = 0;
  float sign_x = 0;
  float sign_z = 0;
  /// The least squared length to which it can be shortened, in cells: one cell less along each
  /// axis, for spheres at the border of their cells.
  float least_squared = 0;
  bool is_diagonal = false;
  FromBorder from_border_x, from_border_z;
  CellsBefore before;
};

constexpr FromBorder fromBorder(int sign) {
  return sign > 0 ? FromBorder{1, 0} : FromBorder{-1, 1};
}

constexpr CellsBefore cellsBefore(int x, int z) {
  const int before_x = x - signOf(x);
  const int before_z = z - signOf(z);
  const int first = z < before_z ? z : before_z;
  const auto bit = [first](int at_x, int at_z) {
    return 16 * (at_z - first) + at_x + kCellsAround;
  };
  const int in_x = bit(before_x, z);
  const int in_z = bit(x, before_z);
  const int both = bit(before_x, before_z);
  return {first + kCellsAround, in_x, in_z, both, 1U << in_x | 1U << in_z | 1U << both};
}

constexpr CellMove cellMove(int x, int z) {
  const int left_x = x - signOf(x);
  const int left_z = z - signOf(z);
  return {static_cast<float>(x),
          static_cast<float>(z),
          static_cast<float>(signOf(x)),
          static_cast<float>(signOf(z)),
          static_cast<float>(left_x * left_x + left_z * left_z),
          x != 0 && z != 0,
          fromBorder(x),
          fromBorder(z),
          cellsBefore(x, z)};
}

/// For each bit of CommonCells that counts the move to its cell.
struct CellMoves {
  static constexpr int kEdge = 2 * kCellsAround + 1;
  CellMove moves[16 * kEdge];
};

constexpr CellMoves cellMoves() {
  CellMoves all{};
  for (int z = -kCellsAround; z <= kCellsAround; ++z) {
    for (int x = -kCellsAround; x <= kCellsAround; ++x) {
      all.moves[16 * (z + kCellsAround) + x + kCellsAround] = cellMove(x, z);
    }
  }
  return all;
}

constexpr CellMoves kCellMoves = cellMoves();

/// By which part of a cell, up to 1, a move by whole cells can be shortened along X and Z so that
/// all spheres stay free. Spheres that are blocked in the cell before limit it.
struct TakenBack {
  float x = 1;
  float z = 1;
};

/// The same in both orders: first along one axis with the whole move along the other, then along
/// the other, where each sphere is in the cell to which the first shortening took it.
struct TakenBackBoth {
  TakenBack along_x_first;
  TakenBack along_z_first;
};

/// Added to cells before rounding, because truncation rounds down only positive numbers.
constexpr float kAboveCells = 64;

/// A move in cells, after which rounding may put spheres up to `rounding` further.
struct CellPush {
  float x = 0;
  float z = 0;
  float rounding = 0;
  /// Only spheres that end nearer than this to the border of a cell need a check: the others are
  /// free.
  float near = 0;
};

/// Which of up to eight groups, as bits, have a sphere that is not free in one of the cells.
inline unsigned deciding(const EightWays* ways, std::size_t count, const CellsBefore& cells) {
  const auto rows_of = [&](std::size_t n) {
    std::int32_t rows = 0;
    __builtin_memcpy(&rows, ways[n].cells.rows + cells.first_row, sizeof(rows));
    return rows;
  };
  static_assert(kWaysAtATime == 8);
  const IntLanes rows{rows_of(0), rows_of(1), rows_of(2), rows_of(3),
                      rows_of(4), rows_of(5), rows_of(6), rows_of(7)};
  const IntLanes blocked = (~rows & static_cast<std::int32_t>(cells.bits)) != 0;
  const unsigned counted = count < kWaysAtATime ? (1U << count) - 1 : (1U << kWaysAtATime) - 1;
  return signsOf(blocked) & counted;
}

/// What limits how much of a move eight spheres can take back.
struct WayLanes {
  /// The sign is set if the sphere is free in that cell.
  IntLanes free_x, free_z, free_both;
  /// Distances from the border that the move crosses last, in cells.
  Lanes to_border_x, to_border_z;
};

inline Lanes placesFrom(const FromBorder& border, const float* part) {
  return spread(border.times) * load(part) + spread(border.plus);
}

inline WayLanes lanesBefore(const EightWays& ways, IntLanes rows, const CellMove& move) {
  // Shifts a cell's bit into the sign.
  const IntLanes above = 31 - loadInts(ways.column);
  const CellsBefore& cells = move.before;
  return {rows << (above - cells.x), rows << (above - cells.z), rows << (above - cells.both),
          placesFrom(move.from_border_x, ways.part_x), placesFrom(move.from_border_z, ways.part_z)};
}

/// `margin`: how far spheres go into a cell, as a part of it. Spheres nearer than that to the
/// border of their cell along the first axis are in the cell before it. `found`: space for as many
/// as there are ways.
inline TakenBackBoth takenBack(const EightWays* ways, std::size_t count, const CellMove& move,
                               float margin, DecidingEight* found) {
  const Lanes whole = spread(1);
  Lanes least_x = whole;
  Lanes least_z = whole;
  std::size_t found_count = 0;
  for (std::size_t first = 0; first < count; first += kWaysAtATime) {
    // In most groups all spheres are free in all of these cells.
    unsigned left = deciding(ways + first, count - first, move.before);
    for (; left != 0; left &= left - 1) {
      const EightWays& eight = ways[first + static_cast<std::size_t>(__builtin_ctz(left))];
      // For each sphere the row in which the move ends and the previous one.
      const IntLanes rows =
          gather<sizeof(*eight.rows)>(eight.rows + move.before.first_row, eight.row);
      found[found_count].ways = &eight;
      storeInts(found[found_count].rows, rows);
      ++found_count;
      const WayLanes way = lanesBefore(eight, rows, move);
      least_x = lesser(least_x, pick(way.free_x < 0, whole, way.to_border_x));
      least_z = lesser(least_z, pick(way.free_z < 0, whole, way.to_border_z));
    }
  }
  TakenBack first;
  leastOf(least_x, least_z, first.x, first.z);
  // For a move along one axis, the order does not matter.
  if (!move.is_diagonal) return {first, first};
  least_x = least_z = whole;
  for (std::size_t n = 0; n < found_count; ++n) {
    const WayLanes way = lanesBefore(*found[n].ways, loadInts(found[n].rows), move);
    const IntLanes behind_x = (way.to_border_x - spread(first.x)) + spread(margin) < spread(0);
    const IntLanes behind_z = (way.to_border_z - spread(first.z)) + spread(margin) < spread(0);
    const IntLanes free_z = behind_x ? way.free_both : way.free_z;
    const IntLanes free_x = behind_z ? way.free_both : way.free_x;
    least_x = lesser(least_x, pick(free_x < 0, whole, way.to_border_x));
    least_z = lesser(least_z, pick(free_z < 0, whole, way.to_border_z));
  }
  TakenBack second;
  leastOf(least_x, least_z, second.x, second.z);
  return {{first.x, second.z}, {second.x, first.z}};
}

/// The range of cells along one axis that may contain a place, relative to the sphere's own cell.
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
  // A sphere that no cell around it blocks may go anywhere.
  if (!is_known) return isFreeEverywhere(ways, sphere);
  return isFreeIn(ways, sphere, x.first, z.first) && isFreeIn(ways, sphere, x.first, z.last) &&
         isFreeIn(ways, sphere, x.last, z.first) && isFreeIn(ways, sphere, x.last, z.last);
}

/// Which places end near the border of a cell. A place that does not move along an axis may lie at
/// a border.
inline IntLanes isNearBorder(const float* part, float by, float near) {
  const Lanes move = spread(by);
  const Lanes cell = (load(part) + move) + spread(kAboveCells);
  const Lanes from_whole = cell - rounded(cell);
  return (from_whole <= near) & (from_whole >= -near) & (move != 0);
}

/// Whether all spheres that end near a border are free in all cells in which they may be.
inline bool areFree(const EightWays* ways, std::size_t count, const CellPush& by) {
  for (std::size_t n = 0; n < count; ++n) {
    const IntLanes near =
        isNearBorder(ways[n].part_x, by.x, by.near) | isNearBorder(ways[n].part_z, by.z, by.near);
    for (unsigned left = signsOf(near) & ways[n].spheres; left != 0; left &= left - 1) {
      if (!isFreeAfter(ways[n], static_cast<std::size_t>(__builtin_ctz(left)), by)) return false;
    }
  }
  return true;
}

/// The cells of a set whose neighbor toward the middle, along each axis, is not in the set: a move
/// never needs to go beyond a free cell.
inline Rows nearestCells(Rows cells) {
  const Rows here = cells & kCells;
  const Rows none{};
  const Rows row_before =
      __builtin_shufflevector(here, none, 16, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14);
  const Rows row_behind =
      __builtin_shufflevector(here, none, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16);
  const Rows beyond = (here << 1 & kBehind) | (here >> 1 & kBefore) | (row_before & kRowsBehind) |
                      (row_behind & kRowsBefore);
  return here & kElsewhere & ~beyond;
}

/// The search over moves by whole cells.
class Search {
 public:
  explicit Search(const WaysQuery& query)
      : query_(query),
        margin_(kIntoCell / query.spacing),
        squared_cell_(query.spacing * query.spacing),
        driven_(__builtin_sqrtf(query.drive_x * query.drive_x + query.drive_z * query.drive_z)) {
    const Rows nearest = nearestCells(loadRows(query.common->rows));
    std::uint64_t words[4];
    __builtin_memcpy(words, &nearest, sizeof(words));
    for (std::size_t n = 0; n < kWords; ++n) moves_[n] = words[n];
  }

  /// `is_each_asked`: whether to check each move with suits(), and reject those that do not suit
  /// all spheres.
  FoundWay run(bool is_each_asked) {
    std::uint64_t moves[kWords] = {moves_[0], moves_[1], moves_[2]};
    FoundWay best;
    float least = query_.longest * query_.longest;
    while ((moves[0] | moves[1] | moves[2]) != 0) {
      const CellMove& move = takeFirst(moves);
      if (move.least_squared * squared_cell_ >= least) continue;
      const FoundWay way = shortened(move);
      if (!(way.squared < least) || !isBack(way)) continue;
      if (is_each_asked && !suits(way)) continue;
      least = way.squared;
      best = way;
    }
    return best;
  }

  [[nodiscard]] bool suits(const FoundWay& way) const {
    // Less than how far spheres go into cells.
    const float rounding = 0.5F * kIntoCell / query_.spacing;
    // A shortened move leaves all spheres free except for those that rounding may take across a
    // border.
    const float near = 1.25F * rounding;
    return areFree(query_.ways, query_.count,
                   {way.x / query_.spacing, way.z / query_.spacing, rounding, near});
  }

 private:
  static constexpr std::size_t kWords = 3;

  /// Takes the first move off a set, without an unpredictable branch.
  static const CellMove& takeFirst(std::uint64_t* moves) {
    const std::size_t word = static_cast<std::size_t>(moves[0] == 0) +
                             static_cast<std::size_t>((moves[0] | moves[1]) == 0);
    const std::size_t bit = 64 * word + static_cast<std::size_t>(__builtin_ctzll(moves[word]));
    moves[word] &= moves[word] - 1;
    return kCellMoves.moves[bit];
  }

  [[nodiscard]] FoundWay shortened(const CellMove& move) const {
    const TakenBackBoth back = takenBack(query_.ways, query_.count, move, margin_, query_.deciding);
    const auto way_of = [&](const TakenBack& taken) {
      const float x = (move.x - move.sign_x * (taken.x - margin_)) * query_.spacing;
      const float z = (move.z - move.sign_z * (taken.z - margin_)) * query_.spacing;
      return FoundWay{x, z, x * x + z * z};
    };
    const FoundWay one = way_of(back.along_x_first);
    const FoundWay other = way_of(back.along_z_first);
    return one.squared > other.squared ? other : one;
  }

  /// Whether a move leads back or sideways.
  [[nodiscard]] bool isBack(const FoundWay& way) const {
    // The largest part of its length that may point along the drive: the cosine of 60 degrees.
    constexpr float kAlongDrive = 0.5F;
    const float along = way.x * query_.drive_x + way.z * query_.drive_z;
    return along <= 0 || along <= kAlongDrive * driven_ * __builtin_sqrtf(way.squared);
  }

  const WaysQuery& query_;
  /// How far spheres go into cells, in cells.
  float margin_ = 0;
  /// The area of a cell, square meters.
  float squared_cell_ = 0;
  float driven_ = 0;
  std::uint64_t moves_[kWords];
};

FoundWay shortestKernel(const WaysQuery& query) noexcept {
  Search search(query);
  const FoundWay way = search.run(false);
  if (way.squared == kNoWay || search.suits(way)) return way;
  // Some sphere, at a border, ends in a cell that the move did not check. Check each sphere for
  // each move.
  return search.run(true);
}

}  // namespace
}  // namespace galactic::simulation
